#include "core/friction/bristles/gms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/roots.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::friction {

std::vector<GmsElement> gms_like_the_spring() {
  const FrictionParameters spring;
  return {
      {spring.k1, 0.9875}, {spring.k2 / 3.0, 0.0009}, {spring.k2 / 3.0, 0.0032}, {spring.k2 / 3.0, 0.0084}};
}

namespace {

/// Gives the formulas of gms_formulas.hpp access to the Maxwell-slip elements.
struct Elements {
  std::span<GmsState> states;

  template <class Visit>
  void each(Visit visit) const {
    for (const GmsState& state : states) visit(state);
  }
  template <class Visit>
  void change(Visit visit) const {
    for (GmsState& state : states) visit(state);
  }
};

double stiffest(std::span<const GmsState> elements) {
  return std::ranges::max(elements, {}, &GmsState::stiffness).stiffness;
}

}  // namespace

GmsSeries GmsMotion::start() const {
  GmsSeries s{};
  s.omega[0] = omega;
  s.decay[0] = decay_at(law.level, omega);
  s.slipping[0] = sums.slipping_torque;
  s.fading[0] = 1.0;
  return s;
}

double GmsMotion::step_of_state(const GmsSeries& series, double tolerance, double duration) const {
  const double torque_tolerance = tolerance * stiffest(elements);
  double step = duration;
  const auto bound = [&](const numerics::Series& of, double error) {
    step = std::min(step, motion::step_within(of, of, series.exponent, error, duration));
  };
  if (sums.slipping_weight > 0.0) {
    bound(series.slipping, torque_tolerance);
    bound(series.fading, torque_tolerance / (law.level.coulomb + law.level.excess));
  }
  if (may_slip(series, step)) bound(series.level, torque_tolerance);
  return step;
}

/// Whether the torque of a sticking element may reach the lowest level at which it slips, that of Fc, within
/// the step (s).
bool GmsMotion::may_slip(const GmsSeries& series, double step) const {
  const double excursion = numerics::excursion_bound(series.position, step);
  return std::any_of(elements.begin(), elements.end(), [&](const GmsState& state) {
    const double highest = direction * state.torque + state.stiffness * excursion;
    return !state.slips && highest >= state.weight * law.level.coulomb;
  });
}

/// Taylor series of a sticking element's margin to slipping, ηi·g(ω) − s·Fi.
numerics::Series GmsMotion::margin_of(const GmsState& state, const GmsSeries& series) const {
  numerics::Series margin;
  for (std::size_t k = 0; k <= numerics::series_order; ++k)
    margin[k] = margin_coefficient(state, direction, series, k);
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
  for (GmsState& state : elements) state.torque = torque_after(state, sums, travel, slipping, fading);
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
  constants_ = {stribeck_curve(contact), contact.gms_attraction, plant.sliding_damping};
  // A constant level bounds no step.
  if (constants_.level.excess == 0.0) constants_.level.per_velocity_squared = 0.0;
  const bool slips = start.sliding && omega_ != 0.0;
  const double level = numerics::sign_of(omega_) * level_at(constants_.level, omega_);
  for (const GmsElement& element : gms_elements_of(friction))
    elements_.push_back({element.stiffness, element.weight, slips ? element.weight * level : 0.0, slips});
  if (slips) return;
  load_slowly(start.preload);
  load_slowly(0.0);
  if (start.holding != 0.0) load_slowly(start.holding);
  for (const double torque : start.history) load_slowly(torque);
  if (!start.history.empty()) load_slowly(0.0);
}

/// Loads the elements slowly to the torque (N m): each yields at ηi·g(0), to which it relaxes in slow motion.
void GmsFriction::load_slowly(double torque) {
  const double direction = numerics::sign_of(torque - this->torque());
  const double level = level_at(constants_.level, 0.0);
  for (std::size_t round = 0; round <= elements_.size(); ++round) {
    double stiffness = 0.0;
    double travel = std::numeric_limits<double>::infinity();  // to the next element that yields, rad
    for (const GmsState& state : elements_) {
      const double margin = state.weight * level - direction * state.torque;
      if (margin <= 0.0) continue;
      stiffness += state.stiffness;
      travel = std::min(travel, margin / state.stiffness);
    }
    const double needed = direction * (torque - this->torque()) / stiffness;
    const bool arrives = needed <= travel;
    for (GmsState& state : elements_) {
      const double highest = state.weight * level;
      const double reached = state.torque + direction * state.stiffness * std::min(needed, travel);
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

/// Stiffness of the softest Maxwell-slip element, N m/rad.
double GmsFriction::softest() const {
  return std::ranges::min(elements_, {}, &GmsState::stiffness).stiffness;
}

bool GmsFriction::sliding() const {
  return std::all_of(elements_.begin(), elements_.end(), [](const GmsState& state) { return state.slips; });
}

double GmsFriction::step(const motion::TorqueCourse& torque, double duration) {
  Elements elements{elements_};
  const bool constant = motion::is_steady(torque);
  if (constant && rest_torque_ == torque.now) return duration;
  rest_torque_.reset();
  if (constant) {
    const bool quiet = motion::load_is_quiet(torque, omega_, plant_.inertia, softest() * tolerance_.rest);
    if (rest_on_elements(elements, torque.now, omega_, level_at(constants_.level, 0.0), plant_.inertia,
                         tolerance_.rest, quiet)) {
      motion::let_load_follow(torque, 0.0);
      omega_ = 0.0;
      rest_torque_ = torque.now;
      return duration;
    }
  }
  const double direction = motion::heading_under(torque, omega_, this->torque());
  const GmsSums<double> sums = begin_to_slip(elements, direction, level_at(constants_.level, omega_));
  GmsConstants<double> law = constants_;
  law.attraction = acting_attraction(constants_, sums);
  GmsMotion motion{elements_, law, direction, theta_, omega_, sums};
  const auto next = motion::taylor_step(motion, plant_.inertia, torque, tolerance_.elongation, duration);
  if (next.event == GmsMotion::Event::velocity_zero) {
    for (GmsState& state : elements_) state.slips = false;
  }
  return next.time;
}

}  // namespace zerocount::friction
