// A certified HLCP solve, warm-started with the right signs, against one plain LU solve of the same order.
//
//   bench_hlcp                        Google Benchmark, one line a side and order
//   bench_hlcp --ratio                the two sides interleaved in one run: HLCP / LU by order, least times of many
//   bench_hlcp --count kernel|lu N    1000 solves of order N and nothing else, to be counted by callgrind
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <slideway/hlcp.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hlcp_chain.hpp"

namespace {

using chain::Problem;
using chain::problem_count;
using chain::problems;

constexpr int stages = 16;

/// LU with partial pivoting and the two triangular solves, certifying nothing, as one writes it: loops over a constant
/// N.
template <int N>
struct LoopLu {
  double lu[N][N];
  double x[N];

  bool solve(const double (&a)[N][N], const double (&b)[N]) {
    double inverse[N];
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) lu[i][j] = a[i][j];
      x[i] = b[i];
    }
    for (int k = 0; k < N; ++k) {
      int p = k;
      double best = std::fabs(lu[k][k]);
      for (int i = k + 1; i < N; ++i)
        if (std::fabs(lu[i][k]) > best) {
          best = std::fabs(lu[i][k]);
          p = i;
        }
      if (best == 0.0) return false;
      if (p != k) {
        for (int j = 0; j < N; ++j) std::swap(lu[k][j], lu[p][j]);
        std::swap(x[k], x[p]);
      }
      inverse[k] = 1.0 / lu[k][k];
      for (int i = k + 1; i < N; ++i) {
        const double l = lu[i][k] * inverse[k];
        lu[i][k] = l;
        for (int j = k + 1; j < N; ++j) lu[i][j] -= l * lu[k][j];
        x[i] -= l * x[k];
      }
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int j = i + 1; j < N; ++j) x[i] -= lu[i][j] * x[j];
      x[i] *= inverse[i];
    }
    return true;
  }
};

/// The same with every means of the kernel: rows in aligned pairs, integer pivot keys, the outer loops written out by
/// templates.
template <int N>
struct WrittenLu {
  static constexpr int stride = N + N % 2;
  alignas(16) double lu[N][stride];
  double x[N];

  using Pair = slideway::hlcp_detail::Pair;
  static Pair load(const double* from) { return slideway::hlcp_detail::load(from); }
  static void store(double* to, Pair pair) { slideway::hlcp_detail::store(to, pair); }

  bool solve(const double (&a)[N][N], const double (&b)[N]) {
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) lu[i][j] = a[i][j];
      if (N % 2 != 0) lu[i][stride - 1] = 0.0;
      x[i] = b[i];
    }
    using slideway::hlcp_detail::each;
    using slideway::hlcp_detail::row_bits;
    constexpr std::integral_constant<int, N> order;
    double inverse[N];
    bool regular = true;
    each(
        order, [&](int k) __attribute__((always_inline)) {
          std::uint64_t best = 0;
          for (int i = k; i < N; ++i) {
            const std::uint64_t key = (slideway::hlcp_detail::bits(std::fabs(lu[i][k])) & ~row_bits) |
                                      (row_bits - static_cast<std::uint64_t>(i));
            best = key > best ? key : best;
          }
          regular = regular && best > row_bits;
          const int p = static_cast<int>(row_bits - (best & row_bits));
          if (p != k) {
            for (int j = 0; j < N; j += 2) {
              const Pair upper = load(&lu[k][j]);
              store(&lu[k][j], load(&lu[p][j]));
              store(&lu[p][j], upper);
            }
            std::swap(x[k], x[p]);
          }
          inverse[k] = 1.0 / lu[k][k];
          for (int i = k + 1; i < N; ++i) {
            const double l = lu[i][k] * inverse[k];
            for (int j = (k + 1) & ~1; j < N; j += 2) store(&lu[i][j], load(&lu[i][j]) - Pair{l, l} * load(&lu[k][j]));
            x[i] -= l * x[k];
          }
        });
    each(
        order, [&](int solved) __attribute__((always_inline)) {
          const int j = N - 1 - solved;
          x[j] *= inverse[j];
          for (int i = 0; i < j; ++i) x[i] -= lu[i][j] * x[j];
        });
    return regular;
  }
};

/// Solves all problems, each `stages` times in a row, since one stage of a step resembles the next. In a chain each
/// solve waits for the one before, as stages do: 2^-600 times its x is added to the matrices' first entries, which
/// changes no bit. Otherwise the processor may overlap them.
template <int N, bool Chain>
[[gnu::noinline]] double kernel_sweep(std::vector<Problem<N>>& all) {
  double sum = 0.0;
  double link = 0.0;
  for (Problem<N>& problem : all)
    for (int stage = 0; stage < stages; ++stage) {
      if (Chain) {
        problem.hlcp.plus[0][0] += link;
        problem.hlcp.minus[0][0] += link;
      }
      slideway::solve(problem.hlcp, std::integral_constant<int, N>{}, problem.solution);
      benchmark::ClobberMemory();
      link = problem.solution.x[0] * 0x1p-600;
      sum += problem.solution.x[0];
    }
  return sum;
}

template <int N, class Lu>
[[gnu::noinline]] bool plain(const double (&w)[N][N], const double (&b)[N], Lu& lu) {
  return lu.solve(w, b);
}

template <int N, class Lu, bool Chain>
[[gnu::noinline]] double lu_sweep(std::vector<Problem<N>>& all) {
  double sum = 0.0;
  double link = 0.0;
  Lu lu;
  for (Problem<N>& problem : all)
    for (int stage = 0; stage < stages; ++stage) {
      if (Chain) problem.w[0][0] += link;
      if constexpr (N <= 2)
        lu.solve(problem.w, problem.hlcp.b);
      else
        plain(problem.w, problem.hlcp.b, lu);
      benchmark::DoNotOptimize(lu);
      link = lu.x[0] * 0x1p-600;
      sum += lu.x[0];
    }
  return sum;
}

template <class Sweep>
double nanoseconds(Sweep sweep, int repeats) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < repeats; ++i) benchmark::DoNotOptimize(sweep());
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  return elapsed.count() / repeats / (problem_count * stages);
}

/// The least times of many short runs, the sides in turn: what other programs of the machine take is not counted.
template <int N, bool Chain>
void compare(const char* how, std::vector<Problem<N>>& all) {
  const int repeats = std::max(1, 100 / (N * N * N / 8 + 10));
  double kernel = HUGE_VAL;
  double loops = HUGE_VAL;
  double written = HUGE_VAL;
  for (int round = 0; round < 1000; ++round) {
    kernel = std::min(kernel, nanoseconds([&] { return kernel_sweep<N, Chain>(all); }, repeats));
    loops = std::min(loops, nanoseconds([&] { return lu_sweep<N, LoopLu<N>, Chain>(all); }, repeats));
    written = std::min(written, nanoseconds([&] { return lu_sweep<N, WrittenLu<N>, Chain>(all); }, repeats));
  }
  std::printf("  %s: HLCP %7.1f ns, LU in loops %7.1f ns, written out %7.1f ns, ratios %.2f and %.2f\n", how, kernel,
              loops, written, kernel / loops, kernel / written);
}

template <int N>
void compare() {
  auto all = problems<N>();
  kernel_sweep<N, false>(all);
  int certified = 0;
  int once = 0;
  for (const auto& problem : all) {
    certified += problem.solution.uniqueness == slideway::Uniqueness::certified ? 1 : 0;
    once += problem.solution.solves == 1 ? 1 : 0;
  }
  std::printf("n = %d: of %d problems, %d with one solve, %d certified unique\n", N, problem_count, once, certified);
  compare<N, true>("one after another", all);
  compare<N, false>("overlapping      ", all);
}

template <int N>
int count(bool kernel) {
  auto all = problems<N>();
  double sum = 0.0;
  for (int round = 0; round < 1024 / problem_count; ++round)
    sum += kernel ? kernel_sweep<N, false>(all) : lu_sweep<N, WrittenLu<N>, false>(all);
  std::printf("%s n = %d: sum %g\n", kernel ? "kernel" : "lu", N, sum);
  return 0;
}

int count(const char* side, const char* order) {
  const bool kernel = std::strcmp(side, "kernel") == 0;
  switch (std::atoi(order)) {
    case 1:
      return count<1>(kernel);
    case 2:
      return count<2>(kernel);
    case 3:
      return count<3>(kernel);
    case 4:
      return count<4>(kernel);
    case 8:
      return count<8>(kernel);
    case 16:
      return count<16>(kernel);
    default:
      std::fprintf(stderr, "order 1, 2, 3, 4, 8 or 16\n");
      return 2;
  }
}

template <int N>
void kernel_benchmark(benchmark::State& state) {
  auto all = problems<N>();
  for (auto _ : state) benchmark::DoNotOptimize(kernel_sweep<N, true>(all));
  state.SetItemsProcessed(state.iterations() * problem_count * stages);
}

template <int N>
void lu_benchmark(benchmark::State& state) {
  auto all = problems<N>();
  for (auto _ : state) benchmark::DoNotOptimize(lu_sweep<N, LoopLu<N>, true>(all));
  state.SetItemsProcessed(state.iterations() * problem_count * stages);
}

BENCHMARK_TEMPLATE(kernel_benchmark, 1);
BENCHMARK_TEMPLATE(lu_benchmark, 1);
BENCHMARK_TEMPLATE(kernel_benchmark, 2);
BENCHMARK_TEMPLATE(lu_benchmark, 2);
BENCHMARK_TEMPLATE(kernel_benchmark, 4);
BENCHMARK_TEMPLATE(lu_benchmark, 4);
BENCHMARK_TEMPLATE(kernel_benchmark, 8);
BENCHMARK_TEMPLATE(lu_benchmark, 8);
BENCHMARK_TEMPLATE(kernel_benchmark, 16);
BENCHMARK_TEMPLATE(lu_benchmark, 16);

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--count") == 0) return count(argv[2], argv[3]);
  if (argc == 2 && std::strcmp(argv[1], "--ratio") == 0) {
    compare<1>();
    compare<2>();
    compare<3>();
    compare<4>();
    compare<8>();
    compare<16>();
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
