#include "core/friction/profile.hpp"

#include <complex>
#include <numbers>

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

}  // namespace zerocount::friction
