#pragma once

#include <algorithm>
#include <cmath>

#include "analysis/statistics/unknown.hpp"

namespace zerocount::sensitivity {

/// A number with its confidence bounds; NaN where there is none.
struct BoundedNumber {
  double value{statistics::unknown};
  double low{statistics::unknown};
  double high{statistics::unknown};
};

/// Whether all numbers from −limit to limit are outside the bounds; false for a number without bounds.
inline bool excludes_up_to(double limit, const BoundedNumber& number) {
  return number.low > limit || number.high < -limit;
}

/// A proportion of which an estimate and bounds are given, held in [0, 1]. Where the estimate is outside, it
/// becomes 0 or 1 and the bound on the other side moves with it (below 0 by as much, above 1 in proportion).
/// So bounds never exclude all that is possible nor shrink to a point, and cover no less often than those
/// given.
inline BoundedNumber clamped_index(BoundedNumber number) {
  if (std::isnan(number.value)) return {};
  number.low = std::min(number.low, number.value);
  number.high = std::max(number.high, number.value);
  if (number.value > 1.0) number.low /= number.value;
  if (number.value < 0.0) number.high -= number.value;
  return {std::clamp(number.value, 0.0, 1.0), std::clamp(number.low, 0.0, 1.0),
          std::clamp(number.high, 0.0, 1.0)};
}

}  // namespace zerocount::sensitivity
