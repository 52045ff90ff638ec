#include "peers.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#ifdef SLIDEWAY_SICONOS
#include <LCP_Solvers.h>
#include <LinearComplementarityProblem.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>
#include <SparseBlockMatrix.h>
#include <lcp_cst.h>

/// OpenBLAS, if that is what Siconos' BLAS is.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
#endif

namespace slideway::charts {

LcpPeer::LcpPeer(int order)
    : n(order),
      m(static_cast<std::size_t>(n * n)),
      q(static_cast<std::size_t>(n)),
      z(static_cast<std::size_t>(n)),
      w(static_cast<std::size_t>(n)) {}

void in_silence(const std::function<void()>& body) {
  std::fflush(stdout);
  const int kept = dup(STDOUT_FILENO), nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  body();
  std::fflush(stdout);
  dup2(kept, STDOUT_FILENO);
  close(nowhere);
  close(kept);
}

#ifdef SLIDEWAY_SICONOS
namespace {

using Call = void (*)(LinearComplementarityProblem*, double*, double*, int*, SolverOptions*);

/// Iterations stop, and pivots are believed, at this error, of min(z, w) over |q|: the default of iterations, 1e-6, is
/// no answer for a step of dynamics, and at that of pivots, 2.2e-14, good answers are refused for their roundings.
constexpr double tolerance = 1e-10;

SolverOptions* options_of(int id) {
  SolverOptions* options = solver_options_create(id);
  options->dparam[SICONOS_DPARAM_TOL] = tolerance;
  return options;
}

/// Its memory is kept for as long as the program runs: Siconos 4.4 does not free the structure itself.
class Dense final : public LcpPeer {
 public:
  Dense(int order, int id, Call call) : LcpPeer(order), call_(call), options_(options_of(id)) {
    // Where a solver can keep its work from call to call.
    if (id == SICONOS_LCP_PIVOT || id == SICONOS_LCP_BARD || id == SICONOS_LCP_MURTY ||
        id == SICONOS_LCP_NEWTON_FB_FBLSA || id == SICONOS_LCP_NEWTON_MIN_FBLSA)
      options_->iparam[SICONOS_IPARAM_PREALLOC] = 1;
    problem_ = {n, NM_create_from_data(NM_DENSE, n, n, m.data()), q.data()};
  }
  bool solve() override {
    if (std::all_of(q.begin(), q.end(), [](double x) { return x >= 0; })) {  // as Siconos' driver does
      std::fill(z.begin(), z.end(), 0);
      w = q;
      return true;
    }
    int info = 1;
    call_(&problem_, z.data(), w.data(), &info, options_);
    return info == 0;
  }

 private:
  Call call_;
  SolverOptions* options_;
  LinearComplementarityProblem problem_;
};

/// Gauss-Seidel over blocks of two, as a guide with two contacts has them, each solved by pivots.
class Blocks final : public LcpPeer {
 public:
  explicit Blocks(int order) : LcpPeer(order), options_(options_of(SICONOS_LCP_NSGS_SBM)) {
    solver_options_update_internal(options_, 0, SICONOS_LCP_LEMKE);
    const unsigned rows = static_cast<unsigned>((n + 1) / 2);
    for (unsigned r = 0; r < rows; ++r) {
      end_.push_back(static_cast<unsigned>(r + 1 == rows ? n : 2 * static_cast<int>(r + 1)));
      first_.push_back(r * rows);
      for (unsigned c = 0; c < rows; ++c) column_.push_back(c);
      diagonal_.push_back(r * (rows + 1));
    }
    first_.push_back(rows * rows);
    numbers_.resize(4 * column_.size());
    for (std::size_t k = 0; k < column_.size(); ++k) block_.push_back(&numbers_[4 * k]);
    SparseBlockStructuredMatrix* matrix = SBM_new();
    matrix->nbblocks = rows * rows;
    matrix->block = block_.data();
    matrix->blocknumber0 = matrix->blocknumber1 = rows;
    matrix->blocksize0 = matrix->blocksize1 = end_.data();
    matrix->filled1 = rows + 1;
    matrix->filled2 = rows * rows;
    matrix->index1_data = first_.data();
    matrix->index2_data = column_.data();
    matrix->diagonal_blocks = diagonal_.data();
    problem_ = {n, NM_new_SBM(n, n, matrix), q.data()};
  }
  void place() override {
    const int rows = static_cast<int>(end_.size());
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int height = n - i / 2 * 2 < 2 ? 1 : 2;
        block_[static_cast<std::size_t>(i / 2 * rows + j / 2)][j % 2 * height + i % 2] =
            m[static_cast<std::size_t>(j * n + i)];
      }
    }
  }
  bool solve() override {
    int info = 1;
    lcp_nsgs_SBM(&problem_, z.data(), w.data(), &info, options_);
    return info == 0;
  }

 private:
  SolverOptions* options_;
  LinearComplementarityProblem problem_;
  std::vector<unsigned> end_, diagonal_;
  std::vector<std::size_t> first_, column_;
  std::vector<double> numbers_;
  std::vector<double*> block_;
};

void least_index(LinearComplementarityProblem* problem, double* z, double* w, int* info, SolverOptions* options) {
  options->iparam[SICONOS_LCP_IPARAM_PIVOTING_METHOD_TYPE] = SICONOS_LCP_PIVOT_LEAST_INDEX;
  lcp_pivot(problem, z, w, info, options);
}

void bard(LinearComplementarityProblem* problem, double* z, double* w, int* info, SolverOptions* options) {
  options->iparam[SICONOS_LCP_IPARAM_PIVOTING_METHOD_TYPE] = SICONOS_LCP_PIVOT_BARD;
  lcp_pivot(problem, z, w, info, options);
}

LcpSolver dense(const std::string& name, int id, Call call, bool takes_start, int most_order = 64) {
  return {name, takes_start, most_order, [=](int n) { return std::make_unique<Dense>(n, id, call); }};
}

}  // namespace

const std::vector<LcpSolver>& lcp_solvers() {
  static const std::vector<LcpSolver> solvers = [] {
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);  // threads cost milliseconds at these orders
    return std::vector<LcpSolver>{
        dense(lexicolemke, SICONOS_LCP_LEMKE, lcp_lexicolemke, false),
        dense("pivot, Lemke", SICONOS_LCP_PIVOT, lcp_pivot, false),
        dense("pivot, least index", SICONOS_LCP_MURTY, least_index, false),
        dense("pivot, Bard", SICONOS_LCP_BARD, bard, false),
        dense("PGS", SICONOS_LCP_PGS, lcp_pgs, true),
        dense("PSOR", SICONOS_LCP_PSOR, lcp_psor, true),
        {"NSGS", true, 64, [](int n) { return std::make_unique<Blocks>(n); }},
        dense("Newton-min", SICONOS_LCP_NEWTONMIN, lcp_newton_min, false),
        dense("Newton-FB", SICONOS_LCP_NEWTON_FB_FBLSA, lcp_newton_FB, true),
        dense("Newton-min-FB", SICONOS_LCP_NEWTON_MIN_FBLSA, lcp_newton_minFB, true),
        dense("enumeration", SICONOS_LCP_ENUM, lcp_enum, false, 8),
    };
  }();
  return solvers;
}
#else
const std::vector<LcpSolver>& lcp_solvers() {
  static const std::vector<LcpSolver> none;
  return none;
}
#endif

}  // namespace slideway::charts
