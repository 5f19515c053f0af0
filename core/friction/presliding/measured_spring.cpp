#include "core/friction/presliding/measured_spring.hpp"

#include <cmath>

#include "core/numerics/bisection.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::friction {
namespace {

/// 1 − exp(−y)
double softened(double y) {
  return -numerics::expm1_of_draws(-y);
}

/// The y at which the condition begins to hold, to the last bit. @param low, high y between them
template <class Condition>
double least_that(double low, double high, const Condition& holds) {
  return numerics::bisect(
             {.holds = high, .fails = low}, holds, [](const auto&) { return false; },
             numerics::geometric_mean)
      .holds;
}

bool is_solved(const Softening& softening) {
  return std::isfinite(softening.k2) && softening.k2 > 0.0 && std::isfinite(softening.beta) &&
         softening.beta > 0.0;
}

}  // namespace

std::optional<Softening> softening_from(double initial, double final, const VirginPoint& point) {
  const double secant = point.torque / point.travel;
  if (!(final < secant && secant < initial)) return std::nullopt;
  const double k2 = initial - final;
  const double ratio = (secant - final) / k2;  // between 1 − y/2 and 1/y
  const double y =
      least_that((initial - secant) / k2, 1.0 / ratio, [&](double at) { return softened(at) <= ratio * at; });
  const Softening found{k2, 0.5 * y / point.travel};
  return is_solved(found) ? std::optional(found) : std::nullopt;
}

std::optional<Softening> softening_through(const VirginPoint& first, const VirginPoint& last, double final) {
  const double secant = first.torque / first.travel;
  const double rest = last.travel - first.travel;
  const double early = first.torque - final * first.travel;
  const double late = last.torque - first.torque - final * rest;
  const double below = secant * last.travel - last.torque;
  if (!(final < secant && rest > 0.0 && early > 0.0 && late > 0.0 && below > 0.0)) return std::nullopt;
  // With both sides less 1: (1 − exp(−t1·y))/(exp(y) − 1) = late/early, which is between t1 − t·t1·y/2 and
  // 1/(exp(y) − 1).
  const double t1 = rest / first.travel;
  const double ratio = late / early;
  const double high = numerics::log1p(1.0 / ratio);
  const double low = std::fmin(below / early / (t1 * (1.0 + t1)), 0.5 * high);
  const double y = least_that(
      low, high, [&](double at) { return softened(t1 * at) <= ratio * numerics::expm1_of_draws(at); });
  const Softening found{early / first.travel * y / softened(y), 0.5 * y / first.travel};
  return is_solved(found) ? std::optional(found) : std::nullopt;
}

}  // namespace zerocount::friction
