#include "core/friction/profile_range.hpp"

#include <algorithm>

#include <boost/math/tools/minima.hpp>

namespace zerocount::friction {
namespace {

/// The lowest of sign·value near `angle`, times sign.
double refined(const Profile& profile, double angle, double spacing, double sign) {
  constexpr int bits = 26;  // of the angle; the value is flat there, so this is far more than it needs
  const auto signed_value = [&](double at) { return sign * value_at(profile, at); };
  return sign *
         boost::math::tools::brent_find_minima(signed_value, angle - spacing, angle + spacing, bits).second;
}

}  // namespace

ValueRange range_over_revolution(const Profile& profile) {
  const std::size_t points = 16 * std::max<std::size_t>(4, profile.cosine.size());
  const double spacing = profile.period / static_cast<double>(points);
  double lowest_angle = 0.0;
  double highest_angle = 0.0;
  ValueRange range{value_at(profile, 0.0), value_at(profile, 0.0)};
  for (std::size_t i = 1; i < points; ++i) {
    const double angle = static_cast<double>(i) * spacing;
    const double value = value_at(profile, angle);
    if (value < range.low) {
      range.low = value;
      lowest_angle = angle;
    }
    if (value > range.high) {
      range.high = value;
      highest_angle = angle;
    }
  }
  return {std::min(range.low, refined(profile, lowest_angle, spacing, 1.0)),
          std::max(range.high, refined(profile, highest_angle, spacing, -1.0))};
}

}  // namespace zerocount::friction
