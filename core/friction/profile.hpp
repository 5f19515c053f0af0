#pragma once

#include <numbers>
#include <vector>

namespace zerocount::friction {

/// Distribution of a friction parameter's values along the axis: a Gaussian random field, or the exponential
/// of one.
enum class Marginal { normal, lognormal };

/// A friction parameter as a function of the position, as drawn for one rotor; periodic over a revolution
/// (over the travel of a linear axis).
///
/// The field is g(θ) = Σ_m cosine[m]·cos(mθ) + sine[m]·sin(mθ), m = 0, 1, …, dimensionless, of unit variance
/// over the ensemble of rotors, with θ = 2π·position/period. The value is location + scale·g (normal) or
/// exp(location + scale·g) (lognormal), in the parameter's unit.
struct Profile {
  Marginal marginal{Marginal::lognormal};
  double location{0.0};        ///< Mean of the normal distribution, or of the logarithm for a lognormal one
  double scale{0.0};           ///< Standard deviation of the normal distribution, or of the logarithm for a
                               ///< lognormal one
  std::vector<double> cosine;  ///< Cosine coefficients of the field, [harmonic m], dimensionless
  std::vector<double> sine;    ///< Sine coefficients of the field, [harmonic m], dimensionless; sine[0] has
                               ///< no effect
  double period{2.0 * std::numbers::pi};  ///< Period of the profile, rad, or m on a linear axis
};

/// The dimensionless Gaussian field g of the profile at `position` (rad, or m on a linear axis).
double field_at(const Profile& profile, double position);

/// The friction parameter's value at `position` (rad, or m on a linear axis; in any period), in the
/// parameter's unit.
double value_at(const Profile& profile, double position);

/// The friction profile with all values multiplied by `factor` (> 0).
Profile scaled(Profile profile, double factor);

/// Lowest and highest value of a friction parameter along the axis, in the parameter's unit.
struct ValueRange {
  double low{0.0};
  double high{0.0};
};

/// The extreme values of a friction profile over one revolution. They are searched at 16 points per shortest
/// wavelength, and the extremes found are refined to 1e-6 relative. If several extremes are nearly equal, the
/// one that is refined may be less extreme than another by some thousandths of the range.
ValueRange range_over_revolution(const Profile& profile);
/// Lowest value of a friction profile over one revolution, as in range_over_revolution() but in half the
/// time.
double lowest_over_revolution(const Profile& profile);

}  // namespace zerocount::friction
