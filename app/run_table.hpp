// The summary of a run that a person reads.
#pragma once

#include <string>
#include <vector>

#include "output.hpp"
#include "recording.hpp"

namespace slideway::app {

std::string run_table(const Recording& recording, const std::vector<const Output*>& outputs);

}  // namespace slideway::app
