#pragma once

#include "core/friction/profile.hpp"

namespace zerocount::friction {

/// Lowest and highest value, in the parameter's unit.
struct ValueRange {
  double low{0.0};
  double high{0.0};
};

/// The extreme values of a profile over a revolution, to 1e-6 relative: searched at 16 points per shortest
/// wavelength, and the extremes then refined.
ValueRange range_over_revolution(const Profile& profile);

}  // namespace zerocount::friction
