#include "measure.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <slideway/hlcp.hpp>
#include <slideway/oracle/hlcp.hpp>

#include "peers.hpp"
#include "timing.hpp"

namespace slideway::charts {
namespace {

/// Each problem is solved as often in a row, since one stage of a step resembles the next.
constexpr int stages = 4;

/// Each solve waits for the one before, as stages do: this part of its answer is added to a diagonal, where it changes
/// no bit.
constexpr double link_scale = 0x1p-600;

template <int N>
using Matrix = Eigen::Matrix<double, N, N>;
template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

/// w - M z = q with M = A+^-1 A-, q = A+^-1 b, w = x+, z = x-: the inverse by cofactors, or LU, whichever is faster.
template <int N>
void to_lcp(const Hlcp<N>& problem, LcpPeer& peer) {
  using Rows = Eigen::Map<const Eigen::Matrix<double, N, N, Eigen::RowMajor>, Eigen::Aligned16>;
  const Rows plus(problem.plus[0]), minus(problem.minus[0]);
  const Eigen::Map<const Vector<N>, Eigen::Aligned16> b(problem.b);
  Eigen::Map<Matrix<N>> m(peer.m.data());
  Eigen::Map<Vector<N>> q(peer.q.data());
  if constexpr (N <= 4) {
    const Matrix<N> inverse = plus.inverse();
    m.noalias() = inverse.lazyProduct(minus);
    q.noalias() = inverse.lazyProduct(b);
  } else {
    const Eigen::PartialPivLU<Matrix<N>> lu(plus);
    m = lu.solve(minus);
    q = lu.solve(b);
  }
  peer.place();
}

/// The problem is an LCP: its numbers as they stand.
template <int N>
void copy_lcp(const Hlcp<N>& problem, LcpPeer& peer) {
  for (int j = 0; j < N; ++j) {
    for (int i = 0; i < N; ++i) peer.m[static_cast<std::size_t>(j * N + i)] = problem.minus[i][j];
    peer.q[static_cast<std::size_t>(j)] = problem.b[j];
  }
  peer.place();
}

/// Answers of any solver against what is true.
class Judge {
 public:
  Judge(const HlcpCase& one, int most_exact)
      : problem_(oracle::exact_hlcp(one.n, one.data.plus, one.data.minus, one.data.b)) {
    if (one.n > most_exact) return;
    const oracle::ExactAnswer answer = oracle::solve(problem_);
    if (answer.count() != oracle::Count::one) throw std::logic_error("a problem without a single solution");
    solution_ = answer.isolated[0];
  }

  void judge(bool success, const double* x, Verdicts& verdicts) const {
    ++(!success ? verdicts.refused : is_right(x) ? verdicts.right : verdicts.wrong);
  }

 private:
  bool is_right(const double* x) const {
    for (int k = 0; k < problem_.n; ++k) {
      if (!std::isfinite(x[k])) return false;
    }
    if (!(oracle::residual(problem_, x) <= hlcp_tolerance)) return false;
    return solution_.empty() ||
           oracle::distance(oracle::exact_vector(x, problem_.n), solution_) <= oracle::Rational(hlcp_tolerance);
  }

  oracle::ExactHlcp problem_;
  oracle::Exact solution_;  ///< empty: of an order at which it is not asked
};

/// One family's problems of one order, and all solvers on them.
template <int N>
class Arena {
 public:
  Arena(const HlcpFamily& family, const HlcpEffort& effort) : family_(family), cases_(family.cases(N, effort.cases)) {
    for (const HlcpCase& one : cases_) {
      Hlcp<N> problem;
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < N; ++j) {
          problem.plus[i][j] = one.data.plus[i][j];
          problem.minus[i][j] = one.data.minus[i][j];
        }
        problem.b[i] = one.data.b[i];
      }
      problems_.push_back(problem);
      judges_.emplace_back(one, effort.most_exact);
    }
    solutions_.resize(cases_.size());
  }

  /// Appends what is measured, and what has still to be timed.
  void enter(std::vector<HlcpMeasured>& measured, std::vector<Run>& runs) {
    enter_kernel(measured, runs);
    for (const LcpSolver& solver : lcp_solvers()) {
      if (N > solver.most_order) continue;
      for (const bool warm : {false, true}) {
        if (warm && !(solver.takes_start && all_solved_)) continue;
        for (const Conversion conversion : {Conversion::none, Conversion::of_theirs}) {
          if (conversion == Conversion::of_theirs && family_.is_lcp) continue;
          enter_peer(solver, warm, conversion, measured, runs);
        }
      }
    }
  }

  static constexpr int solves(std::size_t cases) { return static_cast<int>(cases) * stages; }

 private:
  void enter_kernel(std::vector<HlcpMeasured>& measured, std::vector<Run>& runs) {
    for (const bool warm : {false, true}) {  // the cold answers' signs are right
      HlcpMeasured m{family_.name, N, kernel_solver, warm, Conversion::none, {}};
      for (std::size_t k = 0; k < problems_.size(); ++k) {
        HlcpSolution<N>& solution = solutions_[k];
        if (!warm) solution = {};
        solve(problems_[k], std::integral_constant<int, N>{}, solution);
        judges_[k].judge(solution.status == Status::ok, solution.x, m.verdicts);
        m.certified += solution.uniqueness == Uniqueness::certified ? 1 : 0;
        m.solves += static_cast<double>(solution.solves) / static_cast<double>(problems_.size());
      }
      all_solved_ = m.verdicts.right == static_cast<int>(problems_.size());
      if (all_solved_)
        runs.push_back({name_of(m), [this, warm] { warm ? kernel_sweep<true>() : kernel_sweep<false>(); }});
      measured.push_back(m);
    }
  }

  void enter_peer(const LcpSolver& solver, bool warm, Conversion conversion, std::vector<HlcpMeasured>& measured,
                  std::vector<Run>& runs) {
    HlcpMeasured m{family_.name, N, solver.name, warm, conversion, {}};
    auto peers = std::make_shared<std::vector<std::unique_ptr<LcpPeer>>>();
    for (std::size_t k = 0; k < problems_.size(); ++k) {
      peers->push_back(solver.make(N));
      LcpPeer& peer = *peers->back();
      family_.is_lcp ? copy_lcp(problems_[k], peer) : to_lcp(problems_[k], peer);
      const std::vector<double> kept = peer.m;
      double x[N];
      start(peer, warm, k);
      const bool success = peer.solve();
      for (int i = 0; i < N; ++i) {
        const double z = peer.z[static_cast<std::size_t>(i)], w = peer.w[static_cast<std::size_t>(i)];
        x[i] = z > w ? -z : w;
        if (std::isnan(z)) x[i] = z;
      }
      judges_[k].judge(success, x, m.verdicts);
      if (peer.m != kept) throw std::logic_error(solver.name + " overwrites its matrix");
    }
    if (m.verdicts.right == static_cast<int>(problems_.size())) {
      const bool converts = conversion == Conversion::of_theirs;
      runs.push_back({name_of(m), [=, this] { peer_sweep(*peers, warm, converts); }});
    }
    measured.push_back(m);
  }

  void start(LcpPeer& peer, bool warm, std::size_t k) const {
    for (std::size_t i = 0; i < N; ++i) {
      const double x = solutions_[k].x[i];
      peer.z[i] = warm && x < 0 ? -x * (i % 2 == 0 ? 1 + 1e-3 : 1 - 1e-3) : 0;
    }
  }

  template <bool Warm>
  void kernel_sweep() {
    double link = 0;
    for (std::size_t k = 0; k < problems_.size(); ++k) {
      for (int stage = 0; stage < stages; ++stage) {
        problems_[k].plus[0][0] += link;
        problems_[k].minus[0][0] += link;
        if (!Warm) {
          for (signed char& sign : solutions_[k].sign) sign = 1;
        }
        solve(problems_[k], std::integral_constant<int, N>{}, solutions_[k]);
        benchmark::ClobberMemory();
        link = solutions_[k].x[0] * link_scale;
      }
    }
  }

  void peer_sweep(const std::vector<std::unique_ptr<LcpPeer>>& peers, bool warm, bool converts) {
    double link = 0;
    for (std::size_t k = 0; k < problems_.size(); ++k) {
      LcpPeer& peer = *peers[k];
      for (int stage = 0; stage < stages; ++stage) {
        if (converts) {
          problems_[k].plus[0][0] += link;
          to_lcp(problems_[k], peer);
        } else {
          peer.m[0] += link;
        }
        start(peer, warm, k);
        benchmark::DoNotOptimize(peer.solve());
        benchmark::ClobberMemory();
        link = peer.z[0] * link_scale;
      }
    }
  }

 public:
  static std::string name_of(const HlcpMeasured& m) {
    return fmt::format("{} {} {} {} {}", m.family, m.n, m.solver, m.warm ? "warm" : "cold",
                       m.conversion == Conversion::of_theirs ? "converted" : "");
  }

 private:
  const HlcpFamily& family_;
  std::vector<HlcpCase> cases_;
  std::vector<Hlcp<N>> problems_;
  std::vector<Judge> judges_;
  std::vector<HlcpSolution<N>> solutions_;
  bool all_solved_ = false;
};

template <int N>
void measure_order(const HlcpFamily& family, const HlcpEffort& effort, std::vector<HlcpMeasured>& all) {
  std::vector<HlcpMeasured> measured;
  std::vector<Run> runs;
  Arena<N> arena(family, effort);
  arena.enter(measured, runs);
  const std::string what = fmt::format("{}, n = {}", family.name, N);
  const std::vector<Timing> times = time_in_turns(
      runs, effort.repetitions, effort.least, [&](double part, const std::string&) { effort.progress(part, what); });
  const double solves = Arena<N>::solves(static_cast<std::size_t>(effort.cases));
  for (HlcpMeasured& m : measured) {
    for (std::size_t k = 0; k < runs.size(); ++k) {
      if (runs[k].name != Arena<N>::name_of(m)) continue;
      m.ns = times[k].ns / solves;
      m.ns_low = times[k].low / solves;
      m.ns_high = times[k].high / solves;
    }
    all.push_back(m);
  }
}

template <std::size_t... I>
void measure_orders(const HlcpFamily& family, const HlcpEffort& effort, std::index_sequence<I...>,
                    std::vector<HlcpMeasured>& all) {
  (measure_order<hlcp_orders[I]>(family, effort, all), ...);
}

}  // namespace

std::vector<HlcpMeasured> measure_hlcp(const std::vector<HlcpFamily>& families, const HlcpEffort& effort) {
  std::vector<HlcpMeasured> all;
  in_silence([&] {
    for (const HlcpFamily& family : families)
      measure_orders(family, effort, std::make_index_sequence<std::size(hlcp_orders)>{}, all);
  });
  return all;
}

}  // namespace slideway::charts
