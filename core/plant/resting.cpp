// The plant at rest: nothing swings any more, and creep alone moves the rotor.
#include <algorithm>
#include <cmath>

#include "core/plant/plant.hpp"

namespace zerocount {

std::optional<CreepAtRest> Plant::come_to_rest(double torque) {
  rest_.reset();
  if (!begin_rest(torque, elongation_under(torque, creep_rate()))) return std::nullopt;
  return rest_->creep;
}

/// Whether the rotor is at rest under the constant torque `torque` (N m); if so, puts it there.
bool Plant::begin_rest(double torque, const Elongation& elongation) {
  const double inertia = plant_.inertia;
  const double damping = plant_.presliding_damping;
  const double stiffest = contact_.k1 + contact_.k2;
  const double per_time_squared = stiffest / inertia;
  const double amplitude = tolerance_.rest;
  const double spring_torque = spring_.torque();
  const double creep_now = std::abs(creep_rate());
  // Creep decelerates by α·p, and the spring stretches by the damper's part of that. Most of the time all
  // else is far beyond.
  const double slow_velocity = 2.0 * contact_.alpha * damping * creep_now / contact_.k1;
  const double slow_torque = 2.0 * inertia * contact_.alpha * creep_now;
  if (std::abs(elongation.rate) > amplitude * std::sqrt(per_time_squared) + slow_velocity) return false;
  if (std::abs(torque - damping * omega_ - spring_torque) > amplitude * stiffest + slow_torque) return false;
  if (!(std::abs(torque) + slow_torque < contact_.breakaway)) return false;

  const double sign = spring_torque < 0.0 ? -1.0 : 1.0;
  CreepAtRest creep{.balance = sign * torque, .sign = sign};
  const double left_to_creep =
      sign * torque > 0.0 ? hardening_limit(contact_, torque) - creep_.hardening : 0.0;
  if (creeping_ && left_to_creep > 0.0) {
    // Creep that dies out as fast as the swings do is waited for.
    if (const std::optional<CreepAtRest> found = slow_motion(torque, sign)) {
      creep = *found;
    } else if (left_to_creep > 0.1 * amplitude) {
      return false;
    }
  } else if (!creeping_ && std::abs(torque) > creep_onset_torque_) {
    return false;  // creep is about to set in
  }
  const double torque_at_rest = spring_torque_at_rate(creep, creep.rate);
  const double torque_excess = sign * spring_torque - torque_at_rest;
  const double velocity_excess = sign * omega_ - velocity_at_rate(creep, creep.rate);
  const double acceleration = (torque_excess + damping * velocity_excess) / inertia;
  const double limit = amplitude * per_time_squared;
  const double energy = acceleration * acceleration + per_time_squared * velocity_excess * velocity_excess;
  if (!(energy < limit * limit)) return false;
  const double stiffness = stiffness_on(spring_.branch(), spring_.elongation());
  if (!(std::abs(torque_excess) < 2.0 * amplitude * stiffness)) return false;

  // A rotor that is off by rounding alone stays: it may stand on the edge of a count.
  if (std::abs(torque_excess) > tolerance_.elongation * stiffest) {
    spring_.settle_at_torque(sign * torque_at_rest);
  }
  if (creep.rate > 0.0) {
    spring_.set_direction(static_cast<int>(sign));
  } else if (creeping_) {
    end_creep();
  }
  deepest_ = std::max(deepest_, static_cast<std::int64_t>(spring_.depth()));
  rest_ = Rest{torque, creep, creep_, 0.0};
  return true;
}

/// The motion by creep alone, where it describes the coming motion to a tenth of the rest rule's amplitude.
std::optional<CreepAtRest> Plant::slow_motion(double torque, double sign) const {
  const bool onwards = spring_.direction() == static_cast<int>(sign);
  const double stiffness =
      onwards ? stiffness_on(spring_.branch(), spring_.elongation()) : contact_.k1 + contact_.k2;
  const std::optional<CreepAtRest> creep =
      creep_at_rest(plant_, contact_, torque, sign, stiffness, creep_.hardening);
  if (!creep) return std::nullopt;
  // The spring softens on the way: on each branch, and from a closed loop to the one around it.
  const double last =
      sign * (torque - spring_.torque()) > 0.0 ? spring_.stiffness_at_torque(torque) : stiffness;
  const double error = error_of_creep_at_rest(*creep, plant_, contact_, stiffness, std::min(last, stiffness));
  return error < 0.1 * tolerance_.rest ? creep : std::nullopt;
}

void Plant::go_on_at_rest(double duration) {
  rest_->time += duration;
  const CreepAtRest& creep = rest_->creep;
  double rate = 0.0;
  if (creep.rate > 0.0 && creeping_) {
    rate = creep_rate_after(creep, rest_->time);
    const double growth = creep_until_rate(creep, rate);
    creep_ = {rest_->start.extension + creep.sign * growth, rest_->start.hardening + growth};
    spring_.move_on_to_torque(creep.sign * spring_torque_at_rate(creep, rate));
    if (rate < 0.5 * tolerance_.elongation * creep.g1) {
      end_creep();
      rate = 0.0;
    }
  }
  omega_ = creep.sign * velocity_at_rate(creep, rate);
}

}  // namespace zerocount
