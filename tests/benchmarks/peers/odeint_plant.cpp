#include "tests/benchmarks/peers/odeint_plant.hpp"

#include <functional>
#include <limits>
#include <stdexcept>

namespace zerocount::testing {
namespace {

namespace odeint = boost::numeric::odeint;

using ErrorChecker = odeint::default_error_checker<double, odeint::array_algebra, odeint::default_operations>;

constexpr int max_events = 100000;       // between two samples
constexpr double shortest_step = 1e-12;  // of the one that was tried first
constexpr double max_step = 2.0;         // in the pre-sliding motion, over 1/ω₀
constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

OdeintPlant::Controlled OdeintPlant::controlled(double tolerance) {
  return Controlled(ErrorChecker(tolerance, 0.0, 1.0, 0.0));
}

OdeintPlant::OdeintPlant(const trial::TrialParameters& p, double tolerance)
    : contact_(p),
      tolerance_(tolerance),
      stepper_(controlled(tolerance)),
      now_(contact_.start()),
      proposed_(0.05 / p.controller.sample_rate) {
  restart();
}

void OdeintPlant::set_torque(double torque) {
  stood_ = torque == contact_.law().torque;
  if (stood_) return;
  contact_.set_torque(torque);
  restart();
}

/// Restarts the integration from the present state with the present torque and contact. The slope at the end
/// of the last step cannot be reused, because the next step has another slope.
void OdeintPlant::restart() {
  contact_.begin(now_);
  clock_ = old_time_ = new_time_ = valid_until_ = 0.0;
  pending_ = PeerEvent::none;
  if (contact_.resting()) return;
  new_ = now_;
  contact_.law()(new_, new_slope_, 0.0);
  new_softness_ = contact_.law().softness;
}

void OdeintPlant::advance(double duration) {
  double until = clock_ + duration;
  for (int events = 0; events < max_events; ++events) {
    while (!contact_.resting() && valid_until_ < until && pending_ == PeerEvent::none) step(until);
    if (contact_.resting()) {
      contact_.hold(now_, until - clock_);
      return restart();
    }
    if (until <= valid_until_) {
      clock_ = until;
      now_ = until < new_time_ ? state_at(until) : new_;
      return;
    }
    now_ = last_valid_state();
    until -= valid_until_;
    contact_.happen(pending_, now_);
    restart();
    if (contact_.breakaways() > 0 && !relaxed_) relax();
  }
  throw std::runtime_error("OdeintPlant: events without end");
}

/// Loosens the integrator's tolerance after the first breakaway, when less accuracy is required.
void OdeintPlant::relax() {
  relaxed_ = true;
  stepper_ = controlled(tolerance_after_breakaway * tolerance_);
}

/// Makes one step of the integration method, at most until `until` (s), and handles the event in it.
void OdeintPlant::step(double until) {
  old_ = new_;
  old_slope_ = new_slope_;
  old_softness_ = new_softness_;
  old_time_ = new_time_;
  const double remaining = until - old_time_;
  double length = std::min(proposed_, longest_step());
  const bool ends_at_sample = !stood_ && length > 0.999 * remaining;
  if (ends_at_sample) length = remaining;
  const double tried = length;
  while (stepper_.try_step(std::cref(contact_.law()), old_, old_slope_, new_time_, new_, new_slope_,
                           length) == odeint::fail) {
    if (!(length > shortest_step * tried)) {
      throw std::runtime_error("OdeintPlant: the step does not converge");
    }
  }
  // try_step has set `length` to what it proposes next.
  const bool arrived = ends_at_sample && new_time_ == old_time_ + tried;
  if (arrived) new_time_ = until;
  proposed_ = arrived ? std::max(proposed_, length) : length;
  new_softness_ = contact_.law().softness;
  valid_until_ = new_time_;
  look_for_events();
}

double OdeintPlant::longest_step() const {
  if (!contact_.sliding()) return max_step / contact_.law().per_tau;
  if (!contact_.slows_down(new_slope_)) return never;
  const double widths_to_peak =
      (std::abs(new_[1]) - contact_.peak_in_sight()) * contact_.law().softening_rate;
  return std::max(widths_to_peak, 1.0) * contact_.longest_step_over_peak();
}

PeerState OdeintPlant::state_at(double time) const {
  PeerState y;
  stepper_.stepper().calc_state(time, y, old_, old_slope_, old_time_, new_, new_slope_, new_time_);
  return y;
}

PeerState OdeintPlant::last_valid_state() const {
  return valid_until_ < new_time_ ? state_at(valid_until_) : new_;
}

}  // namespace zerocount::testing
