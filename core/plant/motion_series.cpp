#include "core/plant/motion_series.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount {
namespace {

constexpr double most_exponent_growth = 6.0;
constexpr double negligible_exponent = -40.0;  // exp(−40) = 4e-18

/// |xs − xr|·softening_rate with its sign changed: the exponent of the branch, whose coefficients follow
/// those of xs.
double exponent_coefficient(const SpringBranch& branch, double elongation_coefficient) {
  return -branch.softening_rate * branch.sign * elongation_coefficient;
}

/// Coefficient k ≥ 1 of |σ|ⁿ. The whole exponents 1 and 2 need no division by σ, which may be tiny.
double torque_power_coefficient(const Series& magnitude, const Series& power, double n, std::size_t k) {
  if (n == 1.0) return magnitude[k];
  if (n == 2.0) return square_coefficient(magnitude, k);
  return power_coefficient(magnitude, power, n, k);
}

}  // namespace

PreslidingSeries presliding_series(const PlantParameters& plant, const FrictionParameters& contact,
                                   const HystereticSpring& spring, const CreepState& creep, double omega,
                                   const TorqueCourse& torque, bool creeping) {
  const SpringBranch& branch = spring.branch();
  const Series applied = torque_series(torque);
  PreslidingSeries s{};
  Series& exponent = s.exponent;
  Series slope{};      // −dy/dt
  Series softness{};   // exp(−y)
  Series magnitude{};  // |σ|
  Series power{};      // |σ|ⁿ

  s.elongation[0] = spring.elongation();
  s.omega[0] = omega;
  s.extension[0] = creep.extension;
  s.hardening[0] = creep.hardening;
  exponent[0] = exponent_coefficient(branch, spring.elongation() - branch.elongation);
  softness[0] = std::exp(exponent[0]);
  s.spring_torque[0] = spring.torque();
  const double per_inertia = 1.0 / plant.inertia;
  const double per_lambda = 1.0 / contact.lambda;
  const double torque_sign = s.spring_torque[0] < 0.0 ? -1.0 : 1.0;  // creep never lasts until σ = 0
  magnitude[0] = std::abs(s.spring_torque[0]);
  if (creeping) power[0] = torque_power(contact, magnitude[0]);

  for (std::size_t k = 0; k <= series_order; ++k) {
    if (k > 0) {
      exponent[k] = exponent_coefficient(branch, s.elongation[k]);
      softness[k] = exponential_coefficient(slope, softness, k);
      s.spring_torque[k] = branch.k1 * s.elongation[k] - branch.sign * branch.softening_torque * softness[k];
    }
    if (creeping) {
      magnitude[k] = torque_sign * s.spring_torque[k];
      if (k > 0) power[k] = torque_power_coefficient(magnitude, power, contact.n, k);
      // At k = 0 to the last bit as hardening_limit() has it, so that a reversal is at rest exactly.
      const double limit = k == 0 ? power[0] / contact.lambda : power[k] * per_lambda;
      s.creep_rate[k] = contact.alpha * (limit - s.hardening[k]);
    }
    if (k == series_order) break;
    const double extension_rate = torque_sign * s.creep_rate[k];
    s.elongation_rate[k] = s.omega[k] - extension_rate;
    slope[k] = exponent_coefficient(branch, s.elongation_rate[k]);
    const double acceleration =
        (applied[k] - plant.presliding_damping * s.omega[k] - s.spring_torque[k]) * per_inertia;
    s.hardening[k + 1] = s.creep_rate[k] * reciprocal[k + 1];
    s.extension[k + 1] = extension_rate * reciprocal[k + 1];
    s.elongation[k + 1] = s.elongation_rate[k] * reciprocal[k + 1];
    s.omega[k + 1] = acceleration * reciprocal[k + 1];
  }
  return s;
}

SlidingSeries sliding_series(const PlantParameters& plant, const FrictionParameters& contact, double theta,
                             double omega, double direction, const TorqueCourse& torque) {
  const Series applied = torque_series(torque);
  const double coulomb = contact.coulomb_ratio * contact.breakaway;
  const double stribeck = contact.breakaway - coulomb;
  const double per_velocity_squared = 1.0 / (contact.stribeck_velocity * contact.stribeck_velocity);
  const double per_inertia = 1.0 / plant.inertia;
  SlidingSeries s{};
  Series& exponent = s.exponent;
  Series slope{};      // of the exponent in time
  Series lightness{};  // exp(−(ω/ωs)²)
  s.theta[0] = theta;
  s.omega[0] = omega;
  for (std::size_t k = 0; k < series_order; ++k) {
    exponent[k] = -per_velocity_squared * square_coefficient(s.omega, k);
    if (k > 0) {
      slope[k - 1] = static_cast<double>(k) * exponent[k];
      lightness[k] = exponential_coefficient(slope, lightness, k);
    } else {
      lightness[0] = std::exp(exponent[0]);
    }
    const double driving = k == 0 ? applied[0] - direction * coulomb : applied[k];
    const double acceleration =
        (driving - plant.sliding_damping * s.omega[k] - direction * stribeck * lightness[k]) * per_inertia;
    s.theta[k + 1] = s.omega[k] * reciprocal[k + 1];
    s.omega[k + 1] = acceleration * reciprocal[k + 1];
  }
  return s;
}

double step_within(const Series& position, const Series& velocity, const Series& exponent, double tolerance,
                   double longest) {
  const auto last_terms = [&](double t) {
    double before_last = 1.0;  // t to the power of series_order − 1
    for (std::size_t k = 1; k < series_order; ++k) before_last *= t;
    return before_last * ((std::abs(position[series_order - 1]) + t * std::abs(velocity[series_order - 1])) +
                          t * (std::abs(position[series_order]) + t * std::abs(velocity[series_order])));
  };
  double t = longest;
  for (;;) {
    const double excess = last_terms(t) / (tolerance * t / longest);
    if (!(excess > 1.0) || t == 0.0) break;
    t *= std::clamp(0.9 * std::pow(excess, -1.0 / static_cast<double>(series_order)), 0.01, 0.9);
  }
  const double highest = std::max(exponent[0] + most_exponent_growth, negligible_exponent);
  while (exponent[0] + growth_bound(exponent, t) > highest && t > 0.0) t *= 0.7;
  return t;
}

}  // namespace zerocount
