// Where in a step of Boost.odeint the motion has its kinks, by the dense output.
#include <cstdint>
#include <utility>

#include <boost/math/tools/toms748_solve.hpp>

#include "tests/benchmarks/peers/odeint_plant.hpp"

namespace zerocount::testing {
namespace {

constexpr int bits_of_event_time = 30;

/// Location in (0, h) of the minimum of the cubic with these values and slopes at both ends; 0 if the cubic
/// does not come near zero.
double dip_of(double h, double g0, double slope0, double g1, double slope1) {
  // g = g0 + m0·s + b·s² + a·s³, s = t/h.
  const double m0 = h * slope0;
  const double m1 = h * slope1;
  const double a = 2.0 * (g0 - g1) + m0 + m1;
  const double b = 3.0 * (g1 - g0) - 2.0 * m0 - m1;
  const double root = std::sqrt(std::max(b * b - 3.0 * a * m0, 0.0));
  const double s = -m0 / (b + root);  // of the two extrema, the minimum
  if (!(s > 0.0 && s < 1.0)) return 0.0;
  const double lowest = g0 + s * (m0 + s * (b + s * a));
  return lowest < 0.01 * std::max(g0, g1) ? s * h : 0.0;
}

}  // namespace

void OdeintPlant::look_for_events() {
  if (contact_.sliding()) {
    const auto stop_guard = [this](const PeerState& y) { return contact_.stop_guard(y); };
    if (stop_guard(new_) < 0.0) offer(PeerEvent::stop, stop_guard, new_time_);
    return;
  }
  // The reversal first: up to it the elongation, and with it σ, is monotonic, which the others rely on.
  look_for_reversal();
  const auto closure_guard = [this](const PeerState& y) { return contact_.closure_guard(y[0]); };
  if (closure_guard(last_valid_state()) < 0.0) offer(PeerEvent::closure, closure_guard, valid_until_);
  const auto creep_guard = [this](const PeerState& y) {
    return contact_.creep_guard(contact_.law().spring_torque(y[0]), y[2]);
  };
  if (creep_guard(last_valid_state()) < 0.0) offer(PeerEvent::creep, creep_guard, valid_until_);
  look_for_breakaway();
}

void OdeintPlant::look_for_reversal() {
  const auto guard = [this](const PeerState& y) {
    PeerState slope;
    contact_.law()(y, slope, 0.0);
    return contact_.reversal_guard(slope);
  };
  const double at_start = contact_.reversal_guard(old_slope_);
  const double at_end = contact_.reversal_guard(new_slope_);
  if (at_end < 0.0) return offer(PeerEvent::reversal, guard, new_time_);
  // A turn and a turn back may hide within the step.
  const double direction = contact_.direction();
  const double slope0 = direction * elongation_acceleration(old_, old_slope_, old_softness_);
  const double slope1 = direction * elongation_acceleration(new_, new_slope_, new_softness_);
  if (!(slope0 < 0.0 && slope1 > 0.0)) return;
  const double dip = dip_of(new_time_ - old_time_, at_start, slope0, at_end, slope1);
  if (dip > 0.0 && guard(state_at(old_time_ + dip)) < 0.0) {
    offer(PeerEvent::reversal, guard, old_time_ + dip);
  }
}

/// Acceleration d²xs/dt² of the elongation, rad/s², from the slopes of the state.
double OdeintPlant::elongation_acceleration(const PeerState& y, const PeerState& slope,
                                            double softness) const {
  const PeerMotionLaw& law = contact_.law();
  const double acceleration = slope[1] * law.per_tau;
  if (law.alpha == 0.0) return acceleration;
  const double growth = slope[2];
  const double limit = growth / law.alpha + y[2];
  const double sigma = law.torque - law.damping * contact_.omega(y) - slope[1] / law.tau_per_inertia;
  const double limit_rate = law.n * limit / sigma * law.stiffness(softness) * slope[0];
  return acceleration - law.side * law.alpha * (limit_rate - growth);
}

void OdeintPlant::look_for_breakaway() {
  const PeerMotionLaw& law = contact_.law();
  // The torque at the hook is σ + c·ω = u − J·dω/dt, and its rate the stiffness·dxs/dt + c·dω/dt.
  const auto hook_torque = [&law](const PeerState& slope) {
    return std::abs(law.torque - slope[1] / law.tau_per_inertia);
  };
  const auto hook_rate = [&law](const PeerState& slope, double softness) {
    return std::abs(law.stiffness(softness) * slope[0] + law.damping * law.per_tau * slope[1]);
  };
  const double torque = std::max(hook_torque(old_slope_), hook_torque(new_slope_));
  const double rate = std::max(hook_rate(old_slope_, old_softness_), hook_rate(new_slope_, new_softness_));
  if (torque + (new_time_ - old_time_) * rate < contact_.breakaway_torque()) return;
  const auto guard = [this](const PeerState& y) {
    const PeerMotionLaw& now = contact_.law();
    return contact_.breakaway_guard(now.spring_torque(y[0]) + now.damping * contact_.omega(y), y);
  };
  const double span = valid_until_ - old_time_;  // such steps are rare: look at many places
  constexpr int places = 8;
  for (int i = 1; i <= places; ++i) {
    const double time = old_time_ + span * i / places;
    if (guard(state_at(time)) < 0.0) return offer(PeerEvent::breakaway, guard, time);
  }
}

/// Locates the event at the time where its guard falls below zero. The guard must not be positive at `end`
/// (s).
template <class Guard>
void OdeintPlant::offer(PeerEvent event, Guard guard, double end) {
  const auto value = [&](double time) { return guard(state_at(time)); };
  double low = old_time_;
  double high = end;
  double low_value = guard(old_);
  double high_value = value(high);
  for (int halving = 0; !(low_value > 0.0); ++halving) {  // it begins at zero: find where it has risen
    if (halving == 40) return take(event, high);
    const double middle = 0.5 * (old_time_ + high);
    const double there = value(middle);
    (there > 0.0 ? low : high) = middle;
    (there > 0.0 ? low_value : high_value) = there;
  }
  if (!(high_value < 0.0)) return take(event, high);
  std::uintmax_t iterations = 60;
  const boost::math::tools::eps_tolerance<double> tolerance(bits_of_event_time);
  const auto [from, to] =
      boost::math::tools::toms748_solve(value, low, high, low_value, high_value, tolerance, iterations);
  take(event, 0.5 * (from + to));
}

void OdeintPlant::take(PeerEvent event, double time) {
  valid_until_ = time;
  pending_ = event;
}

}  // namespace zerocount::testing
