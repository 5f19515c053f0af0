#include "core/theory/shortest_move.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/bisection.hpp"

namespace zerocount::theory {

double shortest_move(const DrivenAxis& axis, double distance) {
  if (!(axis.driving > 0.0) || !(axis.braking > 0.0)) return std::numeric_limits<double>::infinity();
  if (!(distance > 0.0)) return 0.0;
  const double undamped =
      std::sqrt(2.0 * distance * axis.inertia * (1.0 / axis.driving + 1.0 / axis.braking));
  // The closed forms divide by c: less than this changes the time by less than 1e-5.
  const double c = std::max(axis.damping, 1e-5 * axis.inertia / undamped);
  const double tau = axis.inertia / c;
  const double terminal = axis.driving / c;
  struct Path {
    double time, travel;
  };
  const auto with_driving_time = [&](double driven) -> Path {
    const double velocity = -terminal * std::expm1(-driven / tau);
    const double braked = tau * std::log1p(velocity * c / axis.braking);
    const double driven_travel = terminal * (driven + tau * std::expm1(-driven / tau));
    const double braked_travel = axis.braking / c * (tau * std::expm1(braked / tau) - braked);
    return {driven + braked, driven_travel + braked_travel};
  };
  double enough = undamped;
  while (with_driving_time(enough).travel < distance) enough *= 2.0;
  const auto reaches = [&](double driven) { return with_driving_time(driven).travel >= distance; };
  return with_driving_time(numerics::bisect({enough, 0.0}, reaches, numerics::after_halvings(50)).holds).time;
}

}  // namespace zerocount::theory
