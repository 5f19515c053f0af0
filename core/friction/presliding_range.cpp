#include "core/friction/presliding_range.hpp"

#include <limits>

#include "core/friction/spring.hpp"

namespace zerocount::friction {

double presliding_range(const FrictionParameters& friction) {
  const bool saturates = friction.k1 == 0.0 && friction.k2 / (2.0 * friction.beta) <= friction.breakaway;
  return saturates ? std::numeric_limits<double>::infinity()
                   : virgin_elongation(friction, friction.breakaway);
}

}  // namespace zerocount::friction
