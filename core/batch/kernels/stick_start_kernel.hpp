#pragma once

#include "core/batch/kernels/coupled_torque.hpp"
#include "core/batch/kernels/series.hpp"
#include "core/friction/presliding/presliding_formulas.hpp"

namespace zerocount::batch {

/// Prepares the step of one vector of lanes whose hook sticks; see stick_start_kernel().
template <class At>
__attribute__((noinline)) void start_step(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  ContactLanes& c = batch.contact;
  const P zero(0.0);
  constexpr double none = __builtin_nan("");  // kernels include no header of the library
  const P elongation = at.load(m.elongation);
  const P hardening = at.load(m.hardening);
  const P torque = at.load(m.torque);
  const P damping = at.load(c.damping);
  const P alpha = at.load(c.alpha);
  const P per_lambda = at.load(c.per_lambda);
  const P exponent = at.load(c.creep_exponent);
  const P per_inertia = at.load(c.per_inertia);
  const P stiffest = at.load(c.stiffest);

  const friction::SpringBranchOf<P> branch{at.load(m.branch_elongation),
                                           at.load(m.branch_torque),
                                           at.load(m.branch_sign),
                                           at.load(c.k1),
                                           at.load(m.branch_softening_torque),
                                           at.load(m.branch_softening_rate)};
  const P travel = friction::travel_on(branch, elongation);
  const P softness = exp(-branch.softening_rate * travel);
  const P spring_torque = friction::torque_after(branch, travel, P(1.0) - softness);
  const P torque_sign = select(spring_torque < zero, P(-1.0), P(1.0));

  Mask creeping = to_mask(at.load(m.creeping)) | (abs(spring_torque) >= at.load(m.creep_onset));
  const P power = torque_power(spring_torque, exponent);
  const P rate = alpha * (power * per_lambda - hardening);
  const Mask ends = creeping & ~(rate > zero);
  creeping = creeping & ~ends;
  const P extension_rate = select(creeping, torque_sign * rate, zero);
  const P omega = select(to_mask(at.load(m.at_reversal)), extension_rate, at.load(m.omega));
  const P elongation_rate = omega - extension_rate;
  const P applied = torque_on_rotor(batch, at, forcing, omega);
  const P unbalanced = applied - damping * omega - spring_torque;
  const P acceleration = unbalanced * per_inertia + alpha * extension_rate;

  const P per_time_squared = stiffest * per_inertia;
  const Mask at_reversal = elongation_rate == zero;
  Mask at_rest = zero < zero;
  Mask rests = at_rest;
  if (forcing.varies) {
    // PreslidingFriction::at_rest. A disturbance that varies allows no rest.
    const P tolerance = at.load(batch.course.tolerance);
    rests = (abs(elongation_rate) < tolerance * sqrt(per_time_squared)) &
            (abs(acceleration) < tolerance * per_time_squared) & (tolerance > zero);
  } else {
    // The rest rule is tried within twice the amplitude of rest, or of a residual oscillation at a reversal,
    // by the leading terms of CreepAtRest.
    const P balance = torque_sign * torque;
    const P creep_limit = torque_power(torque, exponent) * per_lambda;
    const P limit_rate = alpha * (creep_limit - hardening);
    // α·d(|u|ⁿ/λ)/d|u|
    const P limit_slope = select(exponent == P(2.0), P(2.0) * alpha * abs(torque) * per_lambda,
                                 alpha * exponent * creep_limit / max(abs(torque), P(1e-300)));
    const P slow_rate = select(creeping & (balance > zero) & (limit_rate > zero), limit_rate, zero) /
                        (P(1.0) + limit_slope * damping);
    const P torque_excess = torque_sign * spring_torque - (balance - damping * slow_rate);
    const P velocity_excess = torque_sign * omega - slow_rate * (P(1.0) + alpha * damping / stiffest);
    const P acceleration_excess = (torque_excess + damping * velocity_excess) * per_inertia;
    P amplitude = at.load(batch.time.rest);
    if (!forcing.loaded) amplitude = select(at_reversal, at.load(c.max_oscillation), amplitude);
    P limit = P(2.0) * amplitude * per_time_squared;
    if (forcing.loaded) {
      // What the leading terms leave out of quasi-static creep: the inertia of both masses.
      limit = limit + P(2.0) * alpha * slow_rate * (P(1.0) + at.load(batch.load.inertia) * per_inertia);
    }
    at_rest = torque == at.load(m.rest_torque);
    rests = acceleration_excess * acceleration_excess + per_time_squared * velocity_excess * velocity_excess <
            limit * limit;
    if (forcing.loaded) {
      const P steady = -at.load(batch.load.inertia) * alpha * extension_rate;
      const P quiet = P(0.5) * at.load(c.k1) * at.load(batch.time.rest) + P(0.1) * abs(steady);
      rests = rests & load_is_quiet(batch, at, omega, P(2.0) * quiet, steady);
    }
    rests = rests | at_rest;
  }

  const P hook_torque = spring_torque + damping * omega;
  const P motion = select(omega != zero, omega, applied - spring_torque);
  const Mask breaks_away =
      ~rests & (abs(hook_torque) >= at.load(c.breakaway)) & (hook_torque * motion > zero);
  P direction = sign(select(elongation_rate != zero, elongation_rate, acceleration));
  if (forcing.varies) {
    direction = select(direction == zero, sign(torque_rate(batch, at, omega)), direction);
    direction = select(direction == zero, at.load(m.direction), direction);
  }
  const Mask held = ~rests & ~breaks_away;

  at.store(m.spring_torque, spring_torque);
  at.store(m.torque_power, power);
  at.store(m.softness, softness);
  at.store(m.omega, omega);
  at.store(m.heading, direction);
  at.store(m.rest_torque, select(at_rest, torque, P(none)));
  at.store(m.creeping, to_number<P>(creeping));
  at.store(m.at_reversal, to_number<P>(at_reversal));
  add_events(batch, at,
             events_where<P>(rests, may_rest) + events_where<P>(breaks_away, breakaway) +
                 events_where<P>(ends, creep_off) +
                 events_where<P>(held & (direction != at.load(m.direction)), reversal));
}

/// Prepares the step of each lane whose hook sticks: evaluates the spring's hysteresis branch, and reports
/// the events at the start of the step: creep_off, and one of may_rest, breakaway and reversal. See
/// PreslidingFriction::stick. Under a varying torque, may_rest is decided by the rule that the scalar
/// reference engine applies to varying torques.
template <class V>
void stick_start_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { start_step(batch, at, forcing); });
}

}  // namespace zerocount::batch
