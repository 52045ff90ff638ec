// The stepper of scenes that are read at run time, compiled once.
#pragma once

#include <slideway/io/scene_file.hpp>
#include <slideway/step.hpp>

namespace slideway {

extern template class BasicStepper<RunTime<io::RunSize>>;

namespace io {

using RunStepper = RunTimeStepper<RunSize>;

}  // namespace io
}  // namespace slideway
