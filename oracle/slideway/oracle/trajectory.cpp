#include <slideway/oracle/trajectory.hpp>

namespace slideway::oracle {

template class Integrator<Real>;

}  // namespace slideway::oracle
