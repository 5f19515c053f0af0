#pragma once

#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core/friction/profile.hpp"
#include "core/numerics/interval.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount {

/// A stationary random field along the axis, as a manifest describes it.
struct ProfileDescription {
  double mean{1.0};                ///< of the parameter itself, in its unit
  double cv{0.1};                  ///< standard deviation over mean, of the parameter itself
  double correlation_length{0.2};  ///< ℓ, rad or m
  Marginal marginal{Marginal::lognormal};
  double period{2.0 * std::numbers::pi};  ///< a revolution, rad; or the travel, m
};

/// Shortest and longest correlation length of a field with the period 2π; of others in proportion.
constexpr double shortest_correlation_length = 1e-3;
constexpr double longest_correlation_length = 6.283185307179586;

/// Variance S_m that each harmonic m = 0, 1, … gives to the field g of a Profile; Σ S_m = 1.
///
/// The correlation wanted is ρ(d) = exp(−(d/ℓ)²), so that ρ(ℓ) = 1/e, wrapped on the circle and scaled to
/// ρ(0) = 1: ρ(d) ∝ Σ_k exp(−((d + 2πk)/ℓ)²). By Poisson's summation formula its Fourier coefficients are S_0
/// ∝ 1 and S_m ∝ 2·exp(−(mℓ/2)²), all positive, and ρ(d) = Σ S_m·cos(md). Up to ℓ = 1.5 rad the wrapping
/// changes ρ(ℓ) by less than 1e-4; at longer ℓ the field tends to a constant over the rotor. The series is
/// cut where the rest holds less than 1e-12 of the variance, and scaled back to unit variance.
std::vector<double> field_spectrum(double correlation_length);

/// √S_m, m = 0, 1, …
std::vector<double> field_amplitudes(const ProfileDescription& description);

/// One rotor: the profile of a parameter with the random key `key`.
///
/// a_m = √S_m·ξ_m and b_m = √S_m·η_m with ξ_m, η_m independent standard normals, by the inverse distribution
/// function of the draws profile_cosine and profile_sine of the key, with the index m + 2³²·rotor. m = 0 is
/// included: over the rotors the field is stationary with the given mean, and one rotor's own average differs
/// from it. The lognormal marginal has the given mean and cv: s² = ln(1 + cv²), μ = ln(mean) − s²/2.
/// @param amplitudes field_amplitudes of the description.
/// @param rotor 0 where there is one rotor; otherwise the number of the rig.
Profile realise_profile(const ProfileDescription& description, std::span<const double> amplitudes,
                        const RandomKey& key, std::uint32_t rotor = 0);

/// Limits that the realised profile cannot leave: |g| ≤ Σ √(a_m² + b_m²).
Interval limits(const Profile& profile);

}  // namespace zerocount
