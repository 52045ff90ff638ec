// What others do about a friction that follows its own normal force: each in the form that is in wide use.
#pragma once

#include <vector>

#include "exact_instant.hpp"

namespace slideway::charts {

/// x <- S^-1 (b - S* |x|), the friction of the last round's forces, until they repeat to 1e-10; empty after 100 rounds
/// or where they are not finite.
std::vector<double> fixed_point(const ContactProblem& problem);

/// 50 sweeps, contact by contact, each taking the root of its own row that has its sign; the last sweep is the answer,
/// as in engines for games. Empty if it is not finite.
std::vector<double> projected_gauss_seidel(const ContactProblem& problem);

/// Friction -mu |N| tanh(v / width) of the normal forces one step ago, semi-implicit Euler: the contact forces after
/// `steps` steps in which the sliding speed is far above the width, so that tanh is 1. Empty if they are not finite.
std::vector<double> lagged_normal_force(const ContactProblem& problem, int steps);

}  // namespace slideway::charts
