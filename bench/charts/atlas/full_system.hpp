// Contact forces at one instant from Cartesian coordinates of all bodies, by linear algebra as it is usually done, with
// Eigen: signs by iteration, no checks of the result. Empty if they are not finite or the signs never repeat.
#pragma once

#include "exact_instant.hpp"

namespace slideway::charts {

/// The whole system of accelerations and forces by LU with partial pivoting.
std::vector<double> forces_by_lu(const RunScene& scene, const State& state);

/// M^-1, the Schur complement of joints and drives, and that of the contacts, all as inverses: WWZ14 (13)-(19).
std::vector<double> forces_by_inverses(const RunScene& scene, const State& state);

}  // namespace slideway::charts
