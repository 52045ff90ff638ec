// Uses the installed package: 3 x0 + x1 + |x0| = 2, x0 + 3 x1 + |x1| = -3 has the one solution (1, -2).
#include <slideway/hlcp.hpp>

int main() {
  const slideway::Hlcp<2> problem = {{{4, 1}, {1, 4}}, {{2, 1}, {1, 2}}, {2, -3}};
  slideway::HlcpSolution<2> solution = {};
  slideway::solve(problem, 2, solution);
  return solution.status == slideway::Status::ok && solution.x[0] == 1 && solution.x[1] == -2 ? 0 : 1;
}
