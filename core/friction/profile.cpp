#include "core/friction/profile.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::friction {
namespace {

/// The normally distributed value behind the friction parameter: the value itself (normal), or its logarithm
/// (lognormal).
/// @param field Gaussian field g.
double normal_value(const Profile& profile, double field) {
  return profile.location + profile.scale * field;
}

constexpr std::size_t block_size = 16;
using Block = std::array<double, block_size>;

/// The profile's Gaussian field at the angles θ, π − θ, π + θ and −θ. Angles are fractions of a period.
struct FourFields {
  Block ahead, mirrored, opposite, behind;
};

/// The Gaussian field at four times `block_size` angles, from `first` on, `spacing` apart (fractions of a
/// period). Equal to field_at() within rounding, but vectorised: cos mθ and sin mθ at the four angles differ
/// only in sign.
FourFields fields_from(const Profile& profile, double first, double spacing) {
  Block turn_real;
  Block turn_imaginary;
  for (std::size_t i = 0; i < block_size; ++i) {
    const numerics::SineAndCosine turn =
        numerics::sine_and_cosine((first + static_cast<double>(i) * spacing) * (2.0 * std::numbers::pi));
    turn_real[i] = turn.cosine;
    turn_imaginary[i] = turn.sine;
  }
  Block real;
  Block imaginary{};
  std::array<Block, 2> cosines{};  // of even and odd m
  std::array<Block, 2> sines{};
  real.fill(1.0);
  for (std::size_t m = 0; m < profile.cosine.size(); ++m) {
    const double cosine = profile.cosine[m];
    const double sine = profile.sine[m];
    Block& of_cosine = cosines[m % 2];
    Block& of_sine = sines[m % 2];
    for (std::size_t i = 0; i < block_size; ++i) {
      of_cosine[i] += cosine * real[i];
      of_sine[i] += sine * imaginary[i];
      const double next = real[i] * turn_real[i] - imaginary[i] * turn_imaginary[i];
      imaginary[i] = real[i] * turn_imaginary[i] + imaginary[i] * turn_real[i];
      real[i] = next;
    }
  }
  FourFields fields;
  for (std::size_t i = 0; i < block_size; ++i) {
    const double even_cosine = cosines[0][i];
    const double odd_cosine = cosines[1][i];
    const double even_sine = sines[0][i];
    const double odd_sine = sines[1][i];
    fields.ahead[i] = (even_cosine + odd_cosine) + (even_sine + odd_sine);
    fields.mirrored[i] = (even_cosine - odd_cosine) - (even_sine - odd_sine);
    fields.opposite[i] = (even_cosine - odd_cosine) + (even_sine - odd_sine);
    fields.behind[i] = (even_cosine + odd_cosine) - (even_sine + odd_sine);
  }
  return fields;
}

/// Positions of the lowest and the highest value among the searched positions.
struct ExtremePositions {
  double lowest{0.0};   // rad or m
  double highest{0.0};  // rad or m
  double spacing{0.0};  // of the positions searched, rad or m
};

/// Searches the extreme values of a profile at 16 positions per shortest wavelength. The transformation to
/// the parameter's value is monotonic, so the normally distributed values are compared.
ExtremePositions find_extremes(const Profile& profile) {
  constexpr std::size_t alike = 4;  // angles whose fields are found together
  const std::size_t blocks = (std::max<std::size_t>(4, profile.cosine.size()) + alike - 1) / alike;
  const double spacing = 1.0 / static_cast<double>(alike * blocks * block_size);  // of the period
  ExtremePositions found;
  found.spacing = profile.period * spacing;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto compare = [&](const Block& fields, double first, double step) {
    for (std::size_t i = 0; i < block_size; ++i) {
      const double value = normal_value(profile, fields[i]);
      const double position = profile.period * (first + static_cast<double>(i) * step);
      if (value < low) {
        low = value;
        found.lowest = position;
      }
      if (value > high) {
        high = value;
        found.highest = position;
      }
    }
  };
  // From one end of a quarter of the period to the other, in the middle of each interval.
  for (std::size_t block = 0; block < blocks; ++block) {
    const double first = (static_cast<double>(block * block_size) + 0.5) * spacing;
    const FourFields fields = fields_from(profile, first, spacing);
    compare(fields.ahead, first, spacing);
    compare(fields.mirrored, 0.5 - first, -spacing);
    compare(fields.opposite, 0.5 + first, spacing);
    compare(fields.behind, 1.0 - first, -spacing);
  }
  return found;
}

/// Extreme value within `spacing` of `position`: the lowest value if sign is 1, the highest if it is −1.
double refined(const Profile& profile, double position, double spacing, double sign) {
  constexpr int bits = 26;  // of the position; the value is flat there, so this is far more than it needs
  const auto signed_value = [&](double at) { return sign * value_at(profile, at); };
  const double found =
      numerics::minimum_between(position - spacing, position + spacing, bits, signed_value).second;
  return sign * std::min(signed_value(position), found);
}

}  // namespace

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

Profile scaled(Profile profile, double factor) {
  if (profile.marginal == Marginal::lognormal) {
    profile.location += numerics::log_of_draws(factor);
  } else {
    profile.location *= factor;
    profile.scale *= factor;
  }
  return profile;
}

double value_at(const Profile& profile, double position) {
  const double value = normal_value(profile, field_at(profile, position));
  return profile.marginal == Marginal::lognormal ? numerics::exp_of_draws(value) : value;
}

double lowest_over_revolution(const Profile& profile) {
  const ExtremePositions extremes = find_extremes(profile);
  return refined(profile, extremes.lowest, extremes.spacing, 1.0);
}

ValueRange range_over_revolution(const Profile& profile) {
  const ExtremePositions extremes = find_extremes(profile);
  return {refined(profile, extremes.lowest, extremes.spacing, 1.0),
          refined(profile, extremes.highest, extremes.spacing, -1.0)};
}

}  // namespace zerocount::friction
