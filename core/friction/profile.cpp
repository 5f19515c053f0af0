#include "core/friction/profile.hpp"

#include <algorithm>
#include <complex>
#include <cstddef>
#include <numbers>

#include <boost/math/tools/minima.hpp>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {

double field_at(const Profile& profile, double position) {
  // exp(imθ) by repeated multiplication: one sine and one cosine whatever the number of harmonics. The
  // rounding grows like m·2⁻⁵³, which is far below any spread a profile can have.
  const double angle = position * (2.0 * std::numbers::pi / profile.period);
  const std::complex<double> turn{numerics::cos(angle), numerics::sin(angle)};
  std::complex<double> harmonic{1.0, 0.0};
  double field = 0.0;
  for (std::size_t m = 0; m < profile.cosine.size(); ++m) {
    field += profile.cosine[m] * harmonic.real() + profile.sine[m] * harmonic.imag();
    harmonic *= turn;
  }
  return field;
}

double value_at(const Profile& profile, double position) {
  const double value = profile.location + profile.scale * field_at(profile, position);
  return profile.marginal == Marginal::lognormal ? numerics::exp_of_draws(value) : value;
}

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
