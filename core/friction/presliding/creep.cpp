#include "core/friction/presliding/creep.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {

namespace {

constexpr double slow = 0.1;  // max α over the rates at which the rotor's own motion decays

/// Number of rounds of the iteration for the coefficients of CreepAtRest. Each round reduces the error to
/// about 1e-2 of it or less, because the other terms are small beside the leading ones, c·p in S and α·p in
/// dp/dt.
constexpr int rounds = 10;
constexpr int rounds_of_error = 3;  // two digits are enough

/// The rate of creep p₀ that belongs to the hardening xh: solves p₀ = α·(S(p₀)ⁿ/λ − xh) by Newton's
/// iteration, starting with S = U.
double rate_at_hardening(const CreepAtRest& rest, const FrictionParameters& contact, double hardening) {
  double rate = (hardening_limit(contact, rest.balance) - hardening) * rest.g1;
  for (int iteration = 0; iteration < 3; ++iteration) {
    const double torque = spring_torque_at_rate(rest, rate);
    const double limit = hardening_limit(contact, torque);
    const double excess = contact.alpha * (limit - hardening) - rate;
    const double slope = contact.alpha * contact.n * limit / torque * (rest.s1 + 2.0 * rest.s2 * rate) + 1.0;
    rate += excess / slope;
  }
  return rate;
}

}  // namespace

std::optional<CreepAtRest> creep_at_rest(const motion::PlantParameters& plant,
                                         const FrictionParameters& contact, double torque, double sign,
                                         double stiffness, double hardening) {
  const double inertia = plant.inertia;
  const double damping = plant.presliding_damping;
  const double alpha = contact.alpha;
  if (!(alpha < slow * std::min(damping / (2.0 * inertia), stiffness / damping))) return std::nullopt;
  CreepAtRest r{.balance = sign * torque, .sign = sign};
  // α·n·Uⁿ⁻¹/λ and its derivative with respect to U
  const double per_torque = alpha * contact.n * hardening_limit(contact, r.balance) / r.balance;
  const double per_torque_squared = per_torque * (contact.n - 1.0) / r.balance;
  r.g1 = alpha;
  r.s1 = damping;
  const double per_stiffness = 1.0 / stiffness;
  double last_g1 = 0.0;
  for (int round = 0; round < rounds && (round < 3 || last_g1 != r.g1); ++round) {
    last_g1 = r.g1;
    r.w1 = 1.0 + r.g1 * r.s1 * per_stiffness;
    r.w2 = (r.g2 * r.s1 + 2.0 * r.g1 * r.s2) * per_stiffness;
    r.s1 = (damping - inertia * r.g1) * r.w1;
    r.s2 = damping * r.w2 - inertia * (r.g2 * r.w1 + 2.0 * r.g1 * r.w2);
    r.g1 = alpha - per_torque * r.g1 * r.s1;
    r.g2 = per_torque_squared * r.s1 * r.g1 * r.s1 - per_torque * (r.g2 * r.s1 + 2.0 * r.g1 * r.s2);
  }
  const bool found = r.g1 > 0.0 && std::abs(r.g1 - last_g1) < 1e-12 * r.g1;
  if (found) r.rate = rate_at_hardening(r, contact, hardening);
  if (!(r.rate > 0.0)) return std::nullopt;
  return r;
}

double error_of_creep_at_rest(const CreepAtRest& rest, const motion::PlantParameters& plant,
                              const FrictionParameters& contact, double stiffness, double last_stiffness) {
  const CreepAtRest& r = rest;
  const double n = contact.n;
  const double per_torque = contact.alpha * n * hardening_limit(contact, r.balance) / r.balance;
  // The coefficients of p³, in the order dS/dt, w, S, dp/dt.
  const double first = r.g1 * r.s1;
  const double second = 2.0 * r.g1 * r.s2 + r.g2 * r.s1;
  const double curved = (n - 1.0) / r.balance * (r.s1 * second + r.s2 * first) -
                        0.5 * (n - 1.0) * (n - 2.0) * r.s1 * r.s1 / (r.balance * r.balance) * first;
  const double per_stiffness = 1.0 / stiffness;
  double s3 = 0.0;
  double g3 = 0.0;
  for (int round = 0; round < rounds_of_error; ++round) {
    const double third = 3.0 * r.g1 * s3 + 2.0 * r.g2 * r.s2 + g3 * r.s1;
    const double w3 = third * per_stiffness;
    s3 = plant.presliding_damping * w3 - plant.inertia * (3.0 * r.g1 * w3 + 2.0 * r.g2 * r.w2 + g3 * r.w1);
    g3 = -per_torque * (third - curved);
  }
  const double cube = r.rate * r.rate * r.rate;
  // Change of (dS/dt)/k, and so of S, by the softening of the spring.
  const double softened =
      plant.presliding_damping * first * r.rate * (1.0 / last_stiffness - 1.0 / stiffness);
  const double of_torque = std::abs(s3) * cube + softened;
  const double of_rate = std::abs(g3) * cube / (r.g1 * r.g1);
  return 2.0 * (of_rate + of_torque * (1.0 / last_stiffness + per_torque / r.g1));
}

double creep_rate_after(const CreepAtRest& rest, double t) {
  const double z = rest.rate / (rest.g1 + rest.g2 * rest.rate) * numerics::exp(-rest.g1 * t);
  return rest.g1 * z / (1.0 - rest.g2 * z);
}

double creep_until_rate(const CreepAtRest& rest, double rate) {
  // (1/g2)·log(1 + g2·d/a), d the fall of the rate, by its series where g2 is small.
  const double ratio = (rest.rate - rate) / (rest.g1 + rest.g2 * rate);
  const double x = rest.g2 * ratio;
  if (std::abs(x) < 1e-4) return ratio * (1.0 - x * (0.5 - x * (1.0 / 3.0 - 0.25 * x)));
  return numerics::log1p(x) / rest.g2;
}

double rate_after_creep(const CreepAtRest& rest, double growth) {
  const double x = rest.g2 * growth;
  const double ratio =
      growth * (std::abs(x) < 1e-4 ? 1.0 + x * (0.5 + x * (1.0 / 6.0 + x / 24.0)) : numerics::expm1(x) / x);
  return (rest.rate - ratio * rest.g1) / (1.0 + ratio * rest.g2);
}

double time_until_rate(const CreepAtRest& rest, double rate) {
  const double z = rate / (rest.g1 + rest.g2 * rate);
  return numerics::log(rest.rate / (rest.g1 + rest.g2 * rest.rate) / z) / rest.g1;
}

}  // namespace zerocount::friction
