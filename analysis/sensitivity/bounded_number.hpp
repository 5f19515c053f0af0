#pragma once

#include "analysis/statistics/unknown.hpp"

namespace zerocount::sensitivity {

/// A number with its confidence bounds; NaN where there is none.
struct BoundedNumber {
  double value{statistics::unknown};
  double low{statistics::unknown};
  double high{statistics::unknown};
};

/// Whether 0 is outside the bounds. Not where there are none.
inline bool excludes_zero(const BoundedNumber& number) {
  return number.low > 0.0 || number.high < 0.0;
}

/// A proportion of which an estimate and bounds are given, held in [0, 1]. Where the estimate is outside, it
/// becomes 0 or 1 and the bound on the other side moves with it (below 0 by as much, above 1 in proportion).
/// So bounds never exclude all that is possible nor shrink to a point, and cover no less often than those
/// given.
BoundedNumber held_share(BoundedNumber number);

}  // namespace zerocount::sensitivity
