// What has been found and is not mended yet, so that targets find something else. Each goes when its cause goes.
#pragma once

#include <slideway/properties/step.hpp>
#include <string>

namespace slideway::fuzz::known {

/// Friction gives energy, as step_contract() says it: by rounding where hardly any energy crosses the border, and in
/// steps that go over an event, are longer than any motion (dampers are taken at their start) or start off the
/// constraints.
bool gives_energy(const io::RunStepper& stepper, const Report& report, double dt, const std::string& violation);

/// Flows of energy overflow in steps that are longer than any motion.
bool overflows(double dt);

/// The friction of a guide at its limit exceeds it by more than coulomb() has room for, but not by 1e-10 of it.
bool is_at_limit(const std::string& violation);

}  // namespace slideway::fuzz::known
