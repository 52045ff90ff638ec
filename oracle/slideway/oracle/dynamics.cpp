// Compiled once: a multiprecision type costs every file that uses it seconds and hundreds of megabytes.
#include <slideway/oracle/friction.hpp>

namespace slideway::oracle {

template class Dynamics<Real>;
template class FrictionLaw<Real>;

}  // namespace slideway::oracle
