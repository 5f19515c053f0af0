#include "analysis/sensitivity/bounded_number.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount::sensitivity {

BoundedNumber held_share(BoundedNumber number) {
  if (std::isnan(number.value)) return {};
  number.low = std::min(number.low, number.value);
  number.high = std::max(number.high, number.value);
  if (number.value > 1.0) number.low /= number.value;
  if (number.value < 0.0) number.high -= number.value;
  return {std::clamp(number.value, 0.0, 1.0), std::clamp(number.low, 0.0, 1.0),
          std::clamp(number.high, 0.0, 1.0)};
}

}  // namespace zerocount::sensitivity
