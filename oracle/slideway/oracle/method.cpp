#include <slideway/oracle/method.hpp>

namespace slideway::oracle {

template class Method<Real>;

}  // namespace slideway::oracle
