#pragma once

#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core/friction/profile.hpp"
#include "core/numerics/interval.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::distributions {

/// Parameters of a stationary random field: how a friction parameter varies along the axis.
struct ProfileDescription {
  double mean{1.0};  ///< mean of the parameter itself (not its logarithm), in its unit
  double cv{0.1};    ///< coefficient of variation: standard deviation over mean, of the parameter itself
  /// ℓ, the distance at which the correlation is 1/e; rad, or m on a linear axis.
  double correlation_length{0.2};
  friction::Marginal marginal{friction::Marginal::lognormal};
  double period{2.0 * std::numbers::pi};  ///< period of the field: a revolution, rad, or the travel, m

  bool operator==(const ProfileDescription&) const = default;
};

/// Minimum of the correlation length for the period 2π, rad. For another period it scales with the period.
constexpr double min_correlation_length = 1e-3;
constexpr double max_correlation_length = 6.283185307179586;

/// Variance S_m of each harmonic m = 0, 1, … of the field g of a Profile; Σ S_m = 1.
///
/// The correlation is ρ(d) = exp(−(d/ℓ)²), so that ρ(ℓ) = 1/e, wrapped on the circle and scaled to ρ(0) = 1:
/// ρ(d) ∝ Σ_k exp(−((d + 2πk)/ℓ)²). By Poisson's summation formula ρ(d) = Σ S_m·cos(md) with the positive
/// coefficients S_0 ∝ 1 and S_m ∝ 2·exp(−(mℓ/2)²). For ℓ ≤ 1.5 rad the wrapping changes ρ(ℓ) by less than
/// 1e-4; for longer ℓ the field approaches a constant over the rotor. The series is truncated where the
/// remaining variance is below 1e-12, and scaled to unit variance.
std::vector<double> field_spectrum(double correlation_length);

/// Amplitudes √S_m of the harmonics m = 0, 1, … of a random field, with the variances S_m of
/// field_spectrum().
std::vector<double> field_amplitudes(const ProfileDescription& description);

/// The friction parameter along the axis of one rotor (one random realisation of the field), with the random
/// key `key`.
///
/// The field is g = Σ a_m·cos(mθ) + b_m·sin(mθ), with a_m = √S_m·ξ_m and b_m = √S_m·η_m and independent
/// standard normal ξ_m, η_m, from the draws profile_cosine and profile_sine of the key with the index m +
/// 2³²·rotor. m = 0 is included: the average of one rotor differs from the given mean of the field. The
/// lognormal marginal has the given mean and cv: s² = ln(1 + cv²), μ = ln(mean) − s²/2.
/// @param amplitudes field_amplitudes() of the description
/// @param rotor index of the machine; 0 if there is one rotor
friction::Profile realise_profile(const ProfileDescription& description, std::span<const double> amplitudes,
                                  const random::RandomKey& key, std::uint32_t rotor = 0);

/// Bounds that contain the friction parameter at all positions along this profile, from |g| ≤ Σ √(a_m² +
/// b_m²) for its Gaussian field g.
numerics::Interval limits(const friction::Profile& profile);

}  // namespace zerocount::distributions
