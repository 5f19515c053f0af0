#pragma once

#include <vector>

namespace zerocount {

/// How a profile's Gaussian field becomes the parameter's value.
enum class Marginal { normal, lognormal };

/// One realised friction profile: a parameter as a function of the rotor angle, periodic over a revolution.
///
/// The field is g(θ) = Σ_m cosine[m]·cos(mθ) + sine[m]·sin(mθ), m = 0, 1, …, dimensionless, of unit variance
/// over the ensemble. The value is location + scale·g (normal) or exp(location + scale·g) (lognormal), in the
/// parameter's unit.
struct Profile {
  Marginal marginal{Marginal::lognormal};
  double location{0.0};        ///< mean of the normal, or of the logarithm
  double scale{0.0};           ///< standard deviation of the normal, or of the logarithm
  std::vector<double> cosine;  ///< [m], dimensionless
  std::vector<double> sine;    ///< [m], dimensionless; sine[0] has no effect
};

/// The dimensionless field g at `angle` (rad).
double field_at(const Profile& profile, double angle);

/// The parameter's value at the rotor angle `angle` (rad, any revolution), in the parameter's unit.
double value_at(const Profile& profile, double angle);

}  // namespace zerocount
