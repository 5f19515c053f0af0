#pragma once

#include "core/batch/kernels/velocity_step.hpp"
#include "core/friction/sliding/slide_formulas.hpp"

namespace zerocount::batch {

/// Integrates one step of one vector of lanes whose hook slides; see slide_kernel().
template <bool Fast, class At, class F>
__attribute__((noinline)) void slide(BatchState& batch, const At& at, F forcing) {
  using P = typename At::Vector;
  using Mask = typename P::Mask;
  MotionLanes& m = batch.motion;
  ContactLanes& c = batch.contact;
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(time.time_to_stop);
  const P omega = at.load(m.omega);
  const P direction = at.load(m.slide_direction);
  const P coulomb = at.load(c.coulomb);
  const P breakaway_torque = at.load(c.breakaway);
  const P stribeck = direction * (breakaway_torque - coulomb);
  const P per_inertia = at.load(c.per_inertia);
  const P damping = at.load(c.sliding_damping);
  const P per_velocity_squared = at.load(c.per_velocity_squared);
  const P torque = torque_on_rotor(batch, at, forcing, omega);
  const P driving = torque - direction * coulomb;

  const P stribeck_velocity = one / sqrt(per_velocity_squared);
  const P speed = abs(omega);
  P decay_start = zero;
  P h = time_to_stop;
  if constexpr (Fast) {
    P resisting = breakaway_torque - direction * torque + damping * speed;
    if (forcing.any()) h = min(at.load(time.next_step), time_to_stop);
    if (forcing.varies) resisting = resisting + torque_range(batch, at, h);
    h = fast_step(speed, stribeck_velocity, max(resisting, zero) * per_inertia, h);
  } else {
    decay_start = exp(-per_velocity_squared * omega * omega);
    const P acceleration = abs(driving - stribeck * decay_start - damping * omega) * per_inertia;
    h = min(min(at.load(time.next_step),
                stribeck_step(omega, acceleration, stribeck_velocity, per_velocity_squared)),
            time_to_stop);
    h = without_short_remainder(h, time_to_stop);
  }
  friction::SlideSeriesOf<P[batch_order + 1]> s;
  s.position[0] = zero;
  s.omega[0] = omega * h;
  s.decay[0] = decay_start;
  decltype(torque_with<P>(forcing)) applied;
  load_torque(batch, at, forcing, h, one, one, applied);
  const friction::SlideConstants<P> law{
      damping / h,
      in_unit_of_time(friction::StribeckCurveOf<P>{direction * coulomb, stribeck, per_velocity_squared}, h)};
  expand_motion(
      s, applied, h, torque, per_inertia, [&](std::size_t k, const P& u) __attribute__((always_inline)) {
        return friction::slide_coefficient<Fast>(law, s, k, u);
      });

  VelocityStep<P> step = velocity_step(batch, at, time_to_stop, h, last_terms_of(s, applied));
  const P velocity_end = sum_of(s.omega, batch_order);
  step.halts = s.omega[0] * velocity_end < zero;
  Mask unfit = one < zero;
  if constexpr (!Fast) {
    const P curvature = curvature_bound(s.omega, batch_order);
    unfit = grows_too_much(s.exponent) |
            (~step.halts & ~keeps_sign(s.omega[0], velocity_end, s.omega[1], curvature));
    if (forcing.any()) unfit = unfit | (step.halts & ~crosses_once(s.omega, batch_order));
  } else if (forcing.loaded) {
    unfit = ~stays_fast(s.omega, stribeck_velocity, h);
  }
  const Mask beyond = omega * direction <= zero;
  step.too_long = (step.inexact | unfit) & ~beyond;
  const Mask seeks = at.taking_part() & step.halts & ~step.too_long;
  if (seeks.any()) {
    step.x =
        select(step.halts, root_between(s.omega, batch_order, s.omega[0], velocity_end, one, seeks), one);
  }
  step.done = ~step.too_long & ~beyond;
  store_motion(batch, at, s, applied, omega, step);
  const Mask lost = beyond | (at.load(batch.time.steps) > P(max_steps_to_stop));
  add_events(batch, at,
             events_where<P>(step.done & step.halts, velocity_zero) + events_where<P>(lost, beyond_kernel));
}

/// One integration step of each lane whose hook slides. The step ends at the lane's next stop (at which its
/// torque may change), at ω = 0, or where the Taylor series cease to be accurate. Reports velocity_zero, and
/// beyond_kernel where the slide starts at ω = 0. See PreslidingFriction::slide.
///
/// `Fast` is for lanes far above the Stribeck velocity, with (ω/ωs)² > 64, whose friction equals Coulomb
/// friction to the last bit. Their steps end where (ω/ωs)² = 42, because exp(−42) = 6e-19. The torque of a
/// second mass has no bound known in advance, so a step during which (ω/ωs)² falls below 42 is tried and then
/// rejected as too long.
template <class V, bool Fast>
void slide_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_vector<V>(lanes, forcing, [&](const auto& at, auto of) { slide<Fast>(batch, at, of); });
}

}  // namespace zerocount::batch
