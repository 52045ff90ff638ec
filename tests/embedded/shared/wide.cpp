// What the programs of scenes.hpp share, compiled once by each compiler.
#include "../scenes.hpp"

namespace slideway {
template class BasicStepper<RunTime<test::WideSize>>;
}
