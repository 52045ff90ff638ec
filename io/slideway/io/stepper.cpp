#include <slideway/io/stepper.hpp>

namespace slideway {

template class BasicStepper<RunTime<io::RunSize>>;

}  // namespace slideway
