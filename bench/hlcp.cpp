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
#include <random>
#include <slideway/hlcp.hpp>
#include <string>
#include <utility>
#include <vector>

namespace {

using slideway::Hlcp;
using slideway::HlcpSolution;

constexpr int problem_count = 64;

/// What a solve costs when nothing is asked of it: LU with partial pivoting and the two triangular solves. It is
/// written with the means of the kernel (rows in pairs, integer pivot keys, one division a pivot) but certifies
/// nothing.
template <int N>
struct PlainLu {
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
    constexpr std::integral_constant<int, N> order;
    double inverse[N];
    bool regular = true;
    each(
        order, [&](int k) __attribute__((always_inline)) {
          std::uint64_t best = 0;
          for (int i = k; i < N; ++i) {
            const std::uint64_t key = (slideway::hlcp_detail::bits(std::fabs(lu[i][k])) & ~std::uint64_t{31}) |
                                      static_cast<std::uint64_t>(31 - i);
            best = key > best ? key : best;
          }
          regular = regular && best >= 32;
          const int p = 31 - static_cast<int>(best & 31);
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

/// A chain of N + 1 planar bodies (x, y, angle; unit mass, unit inertia), contact i between bodies i and i + 1: random
/// unit normal, random levers of at most 1/2 m, sliding direction at right angles. S = N N', S* = -N T' diag(mu s), mu
/// 0.1 to 0.3, s = +-1; signs of the solution random.
template <int N>
struct Problem {
  Hlcp<N> hlcp;
  HlcpSolution<N> solution;
  double w[N][N];
};

template <int N>
std::vector<Problem<N>> problems() {
  constexpr int columns = 3 * (N + 1);
  std::mt19937_64 random(42);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<Problem<N>> all(problem_count);
  for (Problem<N>& problem : all) {
    double row[N][columns] = {};
    double slide[N][columns] = {};
    for (int i = 0; i < N; ++i) {
      const double angle = 6.283185307179586 * uniform(random);
      for (int body = 0; body < 2; ++body) {
        const double side = body == 0 ? -1.0 : 1.0;
        const int first = 3 * (i + body);
        row[i][first] = -side * std::sin(angle);
        row[i][first + 1] = side * std::cos(angle);
        row[i][first + 2] = uniform(random) - 0.5;
        slide[i][first] = side * std::cos(angle);
        slide[i][first + 1] = side * std::sin(angle);
        slide[i][first + 2] = uniform(random) - 0.5;
      }
    }
    for (int j = 0; j < N; ++j) {
      const double mu = (random() % 2 != 0 ? 1 : -1) * (0.1 + 0.2 * uniform(random));
      for (int i = 0; i < N; ++i) {
        double s = 0.0;
        double star = 0.0;
        for (int k = 0; k < columns; ++k) {
          s += row[i][k] * row[j][k];
          star -= row[i][k] * slide[j][k] * mu;
        }
        problem.hlcp.plus[i][j] = s + star;
        problem.hlcp.minus[i][j] = s - star;
      }
    }
    problem.solution = {};
    double x[N];
    for (int k = 0; k < N; ++k) {
      x[k] = normal(random);
      problem.solution.sign[k] = static_cast<signed char>(x[k] < 0.0 ? -1 : 1);
    }
    for (int i = 0; i < N; ++i) {
      problem.hlcp.b[i] = 0.0;
      for (int j = 0; j < N; ++j) {
        problem.w[i][j] = x[j] < 0.0 ? problem.hlcp.minus[i][j] : problem.hlcp.plus[i][j];
        problem.hlcp.b[i] += problem.w[i][j] * x[j];
      }
    }
  }
  return all;
}

/// Solves all problems. In a chain each waits for the one before, as the stages of a time step do: 2^-600 times its x
/// is added to b, which changes no bit. Otherwise the processor may overlap them.
template <int N, bool Chain>
[[gnu::noinline]] double kernel_sweep(std::vector<Problem<N>>& all) {
  double last = 0.0;
  for (Problem<N>& problem : all) {
    if (Chain) problem.hlcp.b[0] += last * 0x1p-600;
    slideway::solve(problem.hlcp, std::integral_constant<int, N>{}, problem.solution);
    last = problem.solution.x[0];
  }
  return last;
}

template <int N>
[[gnu::noinline]] bool plain(const double (&w)[N][N], const double (&b)[N], PlainLu<N>& lu) {
  return lu.solve(w, b);
}

template <int N, bool Chain>
[[gnu::noinline]] double lu_sweep(std::vector<Problem<N>>& all) {
  double last = 0.0;
  PlainLu<N> lu;
  for (Problem<N>& problem : all) {
    if (Chain) problem.hlcp.b[0] += last * 0x1p-600;
    if constexpr (N <= 2)
      lu.solve(problem.w, problem.hlcp.b);
    else
      plain(problem.w, problem.hlcp.b, lu);
    last = lu.x[0];
  }
  return last;
}

template <class Sweep>
double nanoseconds(Sweep sweep, int repeats) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < repeats; ++i) benchmark::DoNotOptimize(sweep());
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  return elapsed.count() / repeats / problem_count;
}

/// The least time of many short runs, the two sides in turn: what other programs of the machine take is not counted.
template <int N, bool Chain>
double ratio(double& kernel, double& lu, std::vector<Problem<N>>& all) {
  const int repeats = std::max(1, 1000 / (N * N * N / 8 + 10));
  kernel = lu = HUGE_VAL;
  for (int round = 0; round < 2000; ++round) {
    kernel = std::min(kernel, nanoseconds([&] { return kernel_sweep<N, Chain>(all); }, repeats));
    lu = std::min(lu, nanoseconds([&] { return lu_sweep<N, Chain>(all); }, repeats));
  }
  return kernel / lu;
}

template <int N>
void print_ratio(const char* bar) {
  auto all = problems<N>();
  double kernel = 0.0;
  double lu = 0.0;
  const double chained = ratio<N, true>(kernel, lu, all);
  std::printf("n = %2d  in a chain: HLCP %7.1f ns  LU %7.1f ns  ratio %.2f (bar %s)", N, kernel, lu, chained, bar);
  const double overlapping = ratio<N, false>(kernel, lu, all);
  std::printf("  overlapping: HLCP %7.1f ns  LU %7.1f ns  ratio %.2f", kernel, lu, overlapping);
  int certified = 0;
  int once = 0;
  for (const auto& problem : all) {
    certified += problem.solution.uniqueness == slideway::Uniqueness::certified ? 1 : 0;
    once += problem.solution.solves == 1 ? 1 : 0;
  }
  std::printf("  certified %d, one solve %d of %d\n", certified, once, problem_count);
}

template <int N>
int count(bool kernel) {
  auto all = problems<N>();
  double sum = 0.0;
  for (int round = 0; round < 1024 / problem_count; ++round)
    sum += kernel ? kernel_sweep<N, false>(all) : lu_sweep<N, false>(all);
  std::printf("%s n = %d: %d solves, sum %g\n", kernel ? "kernel" : "lu", N, 1024, sum);
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
  state.SetItemsProcessed(state.iterations() * problem_count);
}

template <int N>
void lu_benchmark(benchmark::State& state) {
  auto all = problems<N>();
  for (auto _ : state) benchmark::DoNotOptimize(lu_sweep<N, true>(all));
  state.SetItemsProcessed(state.iterations() * problem_count);
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
    print_ratio<1>("none");
    print_ratio<2>("3.0");
    print_ratio<3>("none");
    print_ratio<4>("2.0");
    print_ratio<8>("1.7");
    print_ratio<16>("1.6");
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
