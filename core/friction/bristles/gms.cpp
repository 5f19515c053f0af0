#include "core/friction/bristles/gms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/first_root.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {

std::vector<GmsElement> gms_like_the_spring() {
  const FrictionParameters spring;
  return {
      {spring.k1, 0.9875}, {spring.k2 / 3.0, 0.0009}, {spring.k2 / 3.0, 0.0032}, {spring.k2 / 3.0, 0.0084}};
}

GmsMotion::GmsMotion(std::span<GmsState> states, const StribeckCurve& level, double rate, double viscous,
                     double sign, double& angle, double& velocity)
    : elements(states),
      curve(level),
      attraction(rate),
      damping(viscous),
      direction(sign),
      theta(angle),
      omega(velocity),
      sticking_torque(0.0),
      sticking_stiffness(0.0),
      slipping_weight(0.0),
      stiffest(0.0) {
  for (const GmsState& state : elements) {
    stiffest = std::max(stiffest, state.element.stiffness);
    if (state.slips) {
      slipping_weight += state.element.weight;
    } else {
      sticking_torque += state.torque;
      sticking_stiffness += state.element.stiffness;
    }
  }
}

GmsSeries GmsMotion::start() const {
  GmsSeries s;
  s.omega[0] = omega;
  s.fading[0] = 1.0;
  for (const GmsState& state : elements) {
    if (state.slips) s.slipping[0] += state.torque;
  }
  return s;
}

void GmsMotion::expand_level(GmsSeries& s, std::size_t k) const {
  if (curve.excess != 0.0) s.level[k] = curve.excess * s.StribeckSeries::expand(curve, s.omega, k);
  if (k == 0) s.level[0] += curve.coulomb;
}

double GmsMotion::expand(GmsSeries& s, std::size_t k, double torque) const {
  expand_level(s, k);
  if (slipping_weight > 0.0 && curve.excess != 0.0) {
    const double per_order = attraction * numerics::reciprocal[k + 1];
    s.slipping_ratio[k] =
        numerics::quotient_coefficient(s.slipping[k], s.level.data(), s.slipping_ratio.data(), k);
    s.fading_ratio[k] = numerics::quotient_coefficient(s.fading[k], s.level.data(), s.fading_ratio.data(), k);
    s.slipping[k + 1] = per_order * ((k == 0 ? direction * slipping_weight : 0.0) - s.slipping_ratio[k]);
    s.fading[k + 1] = -per_order * s.fading_ratio[k];
  }
  s.position[k + 1] = s.omega[k] * numerics::reciprocal[k + 1];
  const double sticking = k == 0 ? sticking_torque : sticking_stiffness * s.position[k];
  return torque - sticking - s.slipping[k] - damping * s.omega[k];
}

double GmsMotion::step_of_state(const GmsSeries& series, double tolerance, double duration) const {
  const double torque_tolerance = tolerance * stiffest;
  double step = duration;
  const auto bound = [&](const numerics::Series& of, double error) {
    step = std::min(step, motion::step_within(of, of, series.exponent, error, duration));
  };
  if (slipping_weight > 0.0) {
    bound(series.slipping, torque_tolerance);
    bound(series.fading, torque_tolerance / (curve.coulomb + curve.excess));
  }
  if (may_slip(series, step)) bound(series.level, torque_tolerance);
  return step;
}

/// Whether a sticking element may come to the lowest level, Fc, within the step.
bool GmsMotion::may_slip(const GmsSeries& series, double step) const {
  const double excursion = numerics::excursion_bound(series.position, step);
  return std::any_of(elements.begin(), elements.end(), [&](const GmsState& state) {
    const double highest = direction * state.torque + state.element.stiffness * excursion;
    return !state.slips && highest >= state.element.weight * curve.coulomb;
  });
}

/// ηi·g(ω) − s·Fi of a sticking element.
numerics::Series GmsMotion::margin_of(const GmsState& state, const GmsSeries& series) const {
  numerics::Series margin;
  for (std::size_t k = 0; k <= numerics::series_order; ++k) {
    margin[k] = state.element.weight * series.level[k] -
                direction * (k == 0 ? state.torque : state.element.stiffness * series.position[k]);
  }
  return margin;
}

motion::NextEvent<GmsMotion::Event> GmsMotion::first_event(const GmsSeries& series, double step) const {
  motion::NextEvent<Event> next{step};
  next.offer(motion::next_sign_change(series.omega, next.time), Event::velocity_zero);
  for (const GmsState& state : elements) {
    if (state.slips) continue;
    next.offer(numerics::first_sign_change(margin_of(state, series), next.time), Event::slip);
  }
  return next;
}

void GmsMotion::go_to(const GmsSeries& series, const motion::NextEvent<Event>& next) {
  const double travel = numerics::value_at(series.position, next.time);
  const double fading = numerics::value_at(series.fading, next.time);
  const double slipping = numerics::value_at(series.slipping, next.time);
  for (GmsState& state : elements) {
    if (state.slips) {
      const double part = state.element.weight / slipping_weight;
      state.torque = part * slipping + (state.torque - part * series.slipping[0]) * fading;
    } else {
      state.torque += state.element.stiffness * travel;
    }
  }
  theta += travel;
  omega = next.event == Event::velocity_zero ? 0.0 : numerics::value_at(series.omega, next.time);
}

LinearContacts GmsFriction::linear_contacts(const motion::PlantParameters& plant,
                                            const FrictionAlongRotor& friction, const FrictionParameters&) {
  double stiffness = 0.0;
  for (const GmsElement& element : gms_elements_of(friction)) stiffness += element.stiffness;
  return {{"while all elements stick", stiffness, plant.sliding_damping}, sliding_contact(plant)};
}

GmsFriction::GmsFriction(const motion::PlantParameters& plant, const FrictionAlongRotor& friction,
                         const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
    : plant_(plant), tolerance_(tolerance), omega_(start.velocity) {
  const FrictionParameters contact = friction_at(friction, start.position);
  curve_ = stribeck_curve(contact);
  attraction_ = contact.gms_attraction;
  for (const GmsElement& element : gms_elements_of(friction)) {
    elements_.push_back({element});
  }
  if (start.sliding && omega_ != 0.0) {
    const double level = numerics::sign_of(omega_) * level_at(curve_, omega_);
    for (GmsState& state : elements_) state = {state.element, state.element.weight * level, true};
    return;
  }
  load_slowly(start.preload);
  load_slowly(0.0);
  if (start.holding != 0.0) load_slowly(start.holding);
  for (const double torque : start.history) load_slowly(torque);
  if (!start.history.empty()) load_slowly(0.0);
}

/// Loads the elements slowly: each yields at ηi·g(0), to which it relaxes in slow motion.
void GmsFriction::load_slowly(double torque) {
  const double direction = numerics::sign_of(torque - this->torque());
  const double level = level_at(curve_, 0.0);
  for (std::size_t round = 0; round <= elements_.size(); ++round) {
    double stiffness = 0.0;
    double travel = std::numeric_limits<double>::infinity();  // to the next element that yields, rad
    for (const GmsState& state : elements_) {
      const double margin = state.element.weight * level - direction * state.torque;
      if (margin <= 0.0) continue;
      stiffness += state.element.stiffness;
      travel = std::min(travel, margin / state.element.stiffness);
    }
    const double needed = direction * (torque - this->torque()) / stiffness;
    const bool arrives = needed <= travel;
    for (GmsState& state : elements_) {
      const double highest = state.element.weight * level;
      const double reached = state.torque + direction * state.element.stiffness * std::min(needed, travel);
      state.torque = std::clamp(reached, -highest, highest);
    }
    if (arrives) return;
  }
}

double GmsFriction::torque() const {
  double sum = 0.0;
  for (const GmsState& state : elements_) sum += state.torque;
  return sum;
}

/// Stiffness of the softest spring, N m/rad.
double GmsFriction::softest() const {
  double least = elements_.front().element.stiffness;
  for (const GmsState& state : elements_) least = std::min(least, state.element.stiffness);
  return least;
}

bool GmsFriction::sliding() const {
  return std::all_of(elements_.begin(), elements_.end(), [](const GmsState& state) { return state.slips; });
}

/// The sign of ω from now on: that of ω or, at ω = 0, of its first derivative that is not 0.
double GmsFriction::direction_under(const motion::TorqueCourse& torque) const {
  if (omega_ != 0.0) return numerics::sign_of(omega_);
  const double excess = motion::torque_on_rotor(torque, omega_) - this->torque();
  if (excess != 0.0) return numerics::sign_of(excess);
  return numerics::sign_of(motion::change_of_torque(torque, omega_));
}

bool GmsFriction::come_to_rest(double torque) {
  const double level = level_at(curve_, 0.0);
  const auto holds = [&](const GmsState& state) {
    return std::abs(state.torque) + state.element.stiffness * tolerance_.rest < state.element.weight * level;
  };
  double stiffness = 0.0;
  for (const GmsState& state : elements_) {
    if (state.slips) return false;
    if (holds(state)) stiffness += state.element.stiffness;
  }
  if (stiffness == 0.0) return false;
  const double shift = (torque - this->torque()) / stiffness;
  if (!(std::abs(shift) + std::abs(omega_) * std::sqrt(plant_.inertia / stiffness) < tolerance_.rest))
    return false;
  for (GmsState& state : elements_) {
    if (holds(state)) state.torque += state.element.stiffness * shift;
  }
  omega_ = 0.0;
  return true;
}

/// Sets elements within rounding of their level in this direction to the level; they slip.
void GmsFriction::begin_to_slip(double direction) {
  constexpr double rounding = 1e-12;
  const double level = direction * level_at(curve_, omega_);
  for (GmsState& state : elements_) {
    const double highest = state.element.weight * level;
    if (state.slips || direction * state.torque < (1.0 - rounding) * direction * highest) continue;
    state.slips = true;
    state.torque = highest;
  }
}

double GmsFriction::step(const motion::TorqueCourse& torque, double duration) {
  const bool constant = motion::is_steady(torque);
  if (constant && rest_torque_ == torque.now) return duration;
  rest_torque_.reset();
  if (constant && motion::load_is_quiet(torque, omega_, plant_.inertia, softest() * tolerance_.rest) &&
      come_to_rest(torque.now)) {
    motion::let_load_follow(torque, 0.0);
    rest_torque_ = torque.now;
    return duration;
  }
  const double direction = direction_under(torque);
  if (direction != 0.0) begin_to_slip(direction);
  GmsMotion motion(elements_, curve_, attraction_, plant_.sliding_damping, direction, theta_, omega_);
  const auto next = motion::taylor_step(motion, plant_.inertia, torque, tolerance_.elongation, duration);
  if (next.event == GmsMotion::Event::velocity_zero) {
    for (GmsState& state : elements_) state.slips = false;
  }
  return next.time;
}

}  // namespace zerocount::friction
