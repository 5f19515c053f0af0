#pragma once

#include <numbers>
#include <vector>

namespace zerocount::friction {

/// Marginal distribution into which a profile transforms its Gaussian field.
enum class Marginal { normal, lognormal };

/// One realised friction profile: a parameter as a function of the position, periodic over a revolution (over
/// the travel of a linear axis).
///
/// The field is g(θ) = Σ_m cosine[m]·cos(mθ) + sine[m]·sin(mθ), m = 0, 1, …, dimensionless, of unit variance
/// over the ensemble, with θ = 2π·position/period. The value is location + scale·g (normal) or exp(location +
/// scale·g) (lognormal), in the parameter's unit.
struct Profile {
  Marginal marginal{Marginal::lognormal};
  double location{0.0};        ///< Mean of the normal distribution, or of the logarithm
  double scale{0.0};           ///< Standard deviation of the normal distribution, or of the logarithm
  std::vector<double> cosine;  ///< [m], dimensionless
  std::vector<double> sine;    ///< [m], dimensionless; sine[0] has no effect
  double period{2.0 * std::numbers::pi};  ///< rad, or m
};

/// The dimensionless field g at `position` (rad or m).
double field_at(const Profile& profile, double position);

/// The parameter's value at `position` (rad or m, in any period), in the parameter's unit.
double value_at(const Profile& profile, double position);

/// The profile with all values multiplied by `factor` (> 0).
Profile scaled(Profile profile, double factor);

/// Lowest and highest value, in the parameter's unit.
struct ValueRange {
  double low{0.0};
  double high{0.0};
};

/// The extreme values of a profile over a revolution: searched at 16 points per shortest wavelength, and the
/// extremes found then refined to 1e-6 relative. If several extremes are nearly equal, the one that is
/// refined may be less extreme than another by some thousandths of the range.
ValueRange range_over_revolution(const Profile& profile);
/// Lowest value over a revolution, as in range_over_revolution() but in half the time.
double lowest_over_revolution(const Profile& profile);

}  // namespace zerocount::friction
