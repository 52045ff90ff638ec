// How to hold your own LCP solver to the exact answers: what a user writes is between the lines. Here the solver is
// Siconos' Lemke, where that is installed, and beside it one that is broken on purpose, which the kit must catch.
#include <cmath>
#include <slideway/properties/rapidcheck.hpp>

#ifdef SLIDEWAY_SICONOS
#include <LCP_Solvers.h>
#include <LinearComplementarityProblem.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>
#include <lcp_cst.h>
#endif

namespace {

using namespace slideway::properties;

/// Projected Gauss and Seidel, told to be content after four sweeps.
bool broken_solver(int n, const double* M, const double* q, double* z) {
  for (int k = 0; k < n; ++k) z[k] = 0;
  for (int sweep = 0; sweep < 4; ++sweep) {
    for (int i = 0; i < n; ++i) {
      double w = q[i];
      for (int j = 0; j < n; ++j) w += M[i * n + j] * z[j];
      if (M[i * n + i] != 0) z[i] = std::fmax(0, z[i] - w / M[i * n + i]);
    }
  }
  return true;
}

#ifdef SLIDEWAY_SICONOS
bool siconos_solver(int n, const double* M, const double* q, double* z) {
  std::vector<double> columns(static_cast<std::size_t>(n * n)), w(static_cast<std::size_t>(n)), right(q, q + n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) columns[static_cast<std::size_t>(j * n + i)] = M[i * n + j];  // column by column
    z[i] = 0;
  }
  NumericsMatrix* matrix = NM_create_from_data(NM_DENSE, n, n, columns.data());
  LinearComplementarityProblem problem{n, matrix, right.data()};
  // Kept: solver_options_delete does not free the structure itself in version 4.4.
  static SolverOptions* const options = solver_options_create(SICONOS_LCP_LEMKE);
  int info = 1;
  lcp_lexicolemke(&problem, z, w.data(), &info, options);
  matrix->matrix0 = nullptr;  // ours
  NM_clear(matrix);
  std::free(matrix);
  return info == 0;
}
#endif

// ---- what a user writes --------------------------------------------------------------------------------------------

template <class Solver>
HlcpCheck judged(const HlcpCase& lcp, const Solver& solve) {
  std::vector<double> M, z(static_cast<std::size_t>(lcp.n));
  for (int i = 0; i < lcp.n; ++i) M.insert(M.end(), lcp.data.minus[i], lcp.data.minus[i] + lcp.n);
  const bool solved = solve(lcp.n, M.data(), lcp.data.b, z.data());
  return check_hlcp(lcp, solved ? lcp_answer(lcp, z.data()) : no_answer(), 1e-10);  // what you promise, relative
}

template <class Solver>
void hold(const Solver& solve) {
  const HlcpCase problem = *lcp(4);
  const HlcpCheck check = judged(problem, solve);
  if (check.judgement == Judgement::disagree) RC_FAIL(check.verdict);
}

// --------------------------------------------------------------------------------------------------------------------

TEST(LcpSolver, ThatIsBrokenIsCaught) {
  // RapidCheck's own result, so that a failure is what is expected.
  const auto result = rc::detail::checkTestable([] { hold(broken_solver); });
  rc::detail::FailureResult failure;
  ASSERT_TRUE(result.match(failure)) << "the broken solver passed";
  // The counterexample is small: of order 1 or 2.
  const std::string shown = failure.counterExample.empty() ? "" : failure.counterExample.front().second;
  RecordProperty("counterexample", shown);
}

#ifdef SLIDEWAY_SICONOS
/// Where there is one solution for every q. Elsewhere it returns x that are none, and success: for M = 0, q = -1/4.
RC_GTEST_PROP(LcpSolver, OfSiconosAgreesOnPMatrices, ()) {
  const HlcpCase problem = *lcp(4);
  const HlcpCheck check = judged(problem, siconos_solver);
  RC_PRE(check.exact->w_property);
  if (!check.agree()) RC_FAIL(check.verdict);
}

TEST(LcpSolver, OfSiconosIsCaught) {
  const double M = 0, q = -0.25;
  const HlcpCheck check = judged(lcp_case(1, &M, &q), siconos_solver);
  EXPECT_EQ(check.judgement, Judgement::disagree) << "mended, in this version";
}
#else
TEST(LcpSolver, OfSiconosAgreesOnPMatrices) {
  GTEST_SKIP() << "needs Siconos' numerics (Debian: libsiconos-numerics-dev)";
}
#endif

}  // namespace
