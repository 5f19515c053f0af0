// The plant at rest: creep moves the rotor, and an oscillation has decayed or is known in closed form.
#include <algorithm>
#include <cmath>

#include "core/friction/presliding/presliding.hpp"

namespace zerocount::friction {

bool PreslidingFriction::come_to_rest(double torque, bool at_reversal, motion::Load* load) {
  const bool was_at_rest = leave_rest();
  const double creep_rate_now = switch_creep();
  if (at_reversal) omega_ = creep_rate_now;
  const motion::TorqueCourse course{.now = torque, .settled = torque, .load = load};
  if (!load_is_quiet(course, creep_rate_now)) return false;
  const double torque_now = motion::torque_on_rotor(course, omega_);
  return begin_rest(torque, elongation_under(torque_now, creep_rate_now), was_at_rest, load == nullptr);
}

/// Whether a second mass permits that the rotor rests: there is none, or its oscillation is small enough to
/// be neglected.
bool PreslidingFriction::load_is_quiet(const motion::TorqueCourse& torque, double creep_rate_now) const {
  return motion::load_is_quiet(torque, omega_, plant_.inertia, 0.5 * contact_.k1 * tolerance_.rest,
                               -contact_.alpha * creep_rate_now);
}

/// Ends the state of rest, if any.
/// @returns whether the rotor was at rest and its residual oscillation had ended.
bool PreslidingFriction::leave_rest() {
  if (!rest_) return false;
  const bool was_at_rest = !(rest_->time < rest_->oscillation.end);
  spring_.place(elongation());
  oscillation_ = {0.0, 0.0, 0.0};
  rest_.reset();
  return was_at_rest;
}

/// Applies the rest rule under the constant torque `torque` (N m).
/// @returns whether the rotor is at rest.
/// @param was_at_rest whether the rotor has been at rest until now, under another torque.
/// @param may_oscillate whether a residual oscillation at a reversal counts as rest.
bool PreslidingFriction::begin_rest(double torque, const Elongation& elongation, bool was_at_rest,
                                    bool may_oscillate) {
  const bool at_reversal = may_oscillate && elongation.rate == 0.0;
  const double max_amplitude = at_reversal ? std::sqrt(tolerance_.rest / contact_.beta) : 0.0;
  const std::optional<Excess> excess =
      excess_over_rest(torque, elongation, std::max(max_amplitude, tolerance_.rest));
  if (!excess) return false;
  const double stiffness = stiffness_on(spring_.branch(), spring_.elongation());
  ResidualOscillation oscillation;
  if (excess->amplitude < tolerance_.rest && std::abs(excess->torque) < 2.0 * tolerance_.rest * stiffness) {
    settle(*excess, was_at_rest);
  } else if (at_reversal && excess->amplitude < max_amplitude && oscillates_freely(torque, *excess)) {
    oscillation = begin_oscillation(*excess);
  } else {
    return false;
  }
  const CreepAtRest& creep = excess->creep;
  if (creep.rate > 0.0) {
    spring_.set_direction(static_cast<int>(creep.sign));
  } else if (creeping_) {
    end_creep();
  }
  deepest_ = std::max(deepest_, depth());
  oscillation_ = oscillation_at(oscillation, 0.0);
  CreepAtRest slow = creep;
  slow.rate += creep.g1 * creep.sign * oscillation_.extension;
  rest_ = Rest{torque, slow, slow_creep(creep.sign), oscillation, 0.0};
  return true;
}

/// State of creep (extension and hardening) without the contribution of the residual oscillation.
/// @param sign sign of the spring torque.
CreepState PreslidingFriction::slow_creep(double sign) const {
  return {creep_.extension - oscillation_.extension, creep_.hardening - sign * oscillation_.extension};
}

/// Deviation of the motion from quasi-static creep under the torque (N m). Empty if the amplitude is above
/// `max_amplitude` (rad), or if creep is as fast as the oscillation.
std::optional<PreslidingFriction::Excess> PreslidingFriction::excess_over_rest(double torque,
                                                                               const Elongation& elongation,
                                                                               double max_amplitude) const {
  const double inertia = plant_.inertia;
  const double damping = plant_.presliding_damping;
  const double stiffest = contact_.k1 + contact_.k2;
  const double per_time_squared = stiffest / inertia;
  const double spring_torque = spring_.torque();
  const double creep_now = std::abs(creep_rate());
  // Quick rejection. Creep decelerates by α·p, and the damper's part of it stretches the spring.
  const double slow_velocity = 2.0 * contact_.alpha * damping * creep_now / contact_.k1;
  const double slow_torque = 2.0 * inertia * contact_.alpha * creep_now;
  if (std::abs(elongation.rate) > max_amplitude * std::sqrt(per_time_squared) + slow_velocity)
    return std::nullopt;
  if (std::abs(torque - damping * omega_ - spring_torque) > max_amplitude * stiffest + slow_torque) {
    return std::nullopt;
  }
  if (!(std::abs(torque) + slow_torque < contact_.breakaway)) return std::nullopt;

  const double sign = spring_torque < 0.0 ? -1.0 : 1.0;
  CreepAtRest creep{.balance = sign * torque, .sign = sign};
  const double remaining_creep =
      sign * torque > 0.0 ? hardening_limit(contact_, torque) - creep_.hardening : 0.0;
  if (creeping_ && remaining_creep > 0.0) {
    // While creep decays as fast as the oscillation, the rotor is not at rest.
    if (const std::optional<CreepAtRest> found = slow_motion(torque, sign)) {
      creep = *found;
    } else if (remaining_creep > 0.1 * tolerance_.rest) {
      return std::nullopt;
    }
  } else if (!creeping_ && std::abs(torque) > creep_onset_torque_) {
    return std::nullopt;  // creep is about to set in
  }
  const double torque_excess = spring_torque - sign * spring_torque_at_rate(creep, creep.rate);
  const double velocity_excess = omega_ - sign * velocity_at_rate(creep, creep.rate);
  const double acceleration = (torque_excess + damping * velocity_excess) / inertia;
  const double energy = acceleration * acceleration + per_time_squared * velocity_excess * velocity_excess;
  return Excess{creep, torque_excess, velocity_excess, std::sqrt(energy) / per_time_squared};
}

/// Moves the spring to the torque at which it rests. A deviation within rounding is kept, because the rotor
/// may stand on the edge of a count. The end of an oscillation leaves no reversal point. A change of the
/// torque on a rotor at rest leaves one, however small, because a slow ramp consists of such changes.
void PreslidingFriction::settle(const Excess& excess, bool was_at_rest) {
  if (!(std::abs(excess.torque) > tolerance_.elongation * (contact_.k1 + contact_.k2))) return;
  const double torque = excess.creep.sign * spring_torque_at_rate(excess.creep, excess.creep.rate);
  if (was_at_rest) {
    spring_.move_to_torque(torque);
  } else {
    spring_.settle_at_torque(torque);
  }
}

/// Whether a ResidualOscillation describes the remaining motion: no breakaway, no closed loop of the spring,
/// and no start or end of creep lies within twice the amplitude. Called at a reversal only.
bool PreslidingFriction::oscillates_freely(double torque, const Excess& excess) const {
  const double margin = 2.0 * excess.amplitude;
  const double torque_margin = margin * (contact_.k1 + contact_.k2);
  if (!(std::abs(torque) + torque_margin < contact_.breakaway)) return false;
  const bool turns_back = spring_.direction() * excess.torque > 0.0;
  if (!turns_back || !(std::abs(spring_.elongation() - spring_.branch().elongation) > margin)) return false;
  const OscillationLaw law = oscillation_law(excess);
  if (!(law.decay > 0.0 && law.frequency > law.decay)) return false;
  if (!creeping_) return std::abs(torque) + torque_margin < creep_onset_torque_;
  if (!(excess.creep.rate > 0.0 && excess.creep.balance > torque_margin)) return false;
  if (!(law.creep < 0.05 * law.frequency && excess.creep.rate > law.creep * margin)) return false;
  return neglected_creep(law, excess) < 0.1 * tolerance_.rest;
}

/// Estimate (rad) of the creep that ResidualOscillation neglects: the second-order term of σⁿ, whose mean
/// over a period is not zero, and the recovery while xh is ahead of its limit.
double PreslidingFriction::neglected_creep(const OscillationLaw& law, const Excess& excess) const {
  const double amplitude = excess.amplitude;
  const double stiffest = contact_.k1 + contact_.k2;
  const double per_time_squared = law.frequency * law.frequency + law.decay * law.decay;
  const double rectified = std::abs(contact_.n - 1.0) * law.creep * stiffest * amplitude * amplitude /
                           (8.0 * excess.creep.balance * law.decay);
  const double recovered = 2.0 * contact_.alpha * law.creep * amplitude / per_time_squared;
  return rectified + 2.0 * recovered;
}

OscillationLaw PreslidingFriction::oscillation_law(const Excess& excess) const {
  const double stiffest = contact_.k1 + contact_.k2;
  const double per_time = plant_.presliding_damping / plant_.inertia;
  OscillationLaw law{0.0, 0.0, 0.0, contact_.k2 * contact_.beta / stiffest};
  if (excess.creep.rate > 0.0) {
    const double limit = hardening_limit(contact_, excess.creep.balance);
    law.creep = stiffest * contact_.alpha * contact_.n * limit / excess.creep.balance;
  }
  law.decay = 0.5 * (per_time + law.creep);
  const double per_time_squared = stiffest / plant_.inertia + per_time * law.creep;
  law.frequency = std::sqrt(std::max(per_time_squared - law.decay * law.decay, 0.0));
  return law;
}

/// Makes the present elongation a reversal point of the spring, and moves the spring to the end of the
/// oscillation.
/// @returns the residual oscillation that begins here.
ResidualOscillation PreslidingFriction::begin_oscillation(const Excess& excess) {
  const CreepAtRest& creep = excess.creep;
  const double from = spring_.elongation();
  spring_.set_direction(-spring_.direction());
  spring_.move_on_to_torque(creep.sign * spring_torque_at_rate(creep, creep.rate));
  return residual_oscillation(oscillation_law(excess), from - spring_.elongation(), excess.velocity,
                              tolerance_.elongation);
}

/// The slow motion by creep alone, under the torque (N m); empty if its error exceeds a tenth of the
/// amplitude that counts as rest.
std::optional<CreepAtRest> PreslidingFriction::slow_motion(double torque, double sign) const {
  const bool onwards = spring_.direction() == static_cast<int>(sign);
  const double stiffness =
      onwards ? stiffness_on(spring_.branch(), spring_.elongation()) : contact_.k1 + contact_.k2;
  motion::PlantParameters whole = plant_;
  whole.inertia += plant_.load.inertia;  // which moves with the rotor
  const std::optional<CreepAtRest> creep =
      creep_at_rest(whole, contact_, torque, sign, stiffness, creep_.hardening);
  if (!creep) return std::nullopt;
  // The spring softens on the way: on each branch, and from a closed loop to the one around it.
  const double last =
      sign * (torque - spring_.torque()) > 0.0 ? spring_.point_at_torque(torque).stiffness : stiffness;
  const double error = error_of_creep_at_rest(*creep, whole, contact_, stiffness, std::min(last, stiffness));
  return error < 0.1 * tolerance_.rest ? creep : std::nullopt;
}

PreslidingFriction::RestPoint PreslidingFriction::point_at_rest(double time) const {
  const double later = rest_->time + time;
  RestPoint point{later, 0.0, 0.0, oscillation_at(rest_->oscillation, later)};
  if (rest_->creep.rate > 0.0 && creeping_) {
    point.rate = creep_rate_after(rest_->creep, later);
    point.growth = creep_until_rate(rest_->creep, point.rate);
  }
  return point;
}

double PreslidingFriction::theta_at(const RestPoint& point) const {
  const CreepAtRest& creep = rest_->creep;
  double slow = hook_ + spring_.elongation() + slow_creep(creep.sign).extension;
  if (creep.rate > 0.0 && creeping_) {
    const double torque = creep.sign * spring_torque_at_rate(creep, point.rate);
    const bool moves = creep.sign * (torque - spring_.torque()) > 0.0;
    const double elongation = moves ? spring_.point_at_torque(torque).elongation : spring_.elongation();
    slow = hook_ + elongation + rest_->start.extension + creep.sign * point.growth;
  }
  return slow + point.oscillation.elongation + point.oscillation.extension;
}

void PreslidingFriction::go_to(const RestPoint& point) {
  rest_->time = point.time;
  const CreepAtRest& creep = rest_->creep;
  creep_ = slow_creep(creep.sign);
  double rate = 0.0;
  if (creep.rate > 0.0 && creeping_) {
    rate = point.rate;
    creep_ = {rest_->start.extension + creep.sign * point.growth, rest_->start.hardening + point.growth};
    spring_.move_on_to_torque(creep.sign * spring_torque_at_rate(creep, rate));
    if (rate < 0.5 * tolerance_.elongation * creep.g1) {
      end_creep();
      rate = 0.0;
    }
  }
  oscillation_ = point.oscillation;
  creep_ = {creep_.extension + oscillation_.extension,
            creep_.hardening + creep.sign * oscillation_.extension};
  omega_ = creep.sign * velocity_at_rate(creep, rate) + oscillation_.velocity;
}

}  // namespace zerocount::friction
