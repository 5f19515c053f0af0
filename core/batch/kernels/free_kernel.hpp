#pragma once

#include "core/batch/kernels/coupled_torque.hpp"
#include "core/batch/kernels/velocity_step.hpp"

namespace zerocount::batch {

/// Moves each lane without friction to its next stop, one sample ahead, by the linear map of
/// friction::free_motion. If it `varies` the torque is CourseLanes::settled and a lag.
template <class V>
void free_kernel(BatchState& batch, const LaneSet& lanes, bool varies) {
  for_each_stretch<V>(lanes, [&]<class At>(const At& at) {
    using P = typename At::Vector;
    MotionLanes& m = batch.motion;
    const FreeLanes& f = batch.free;
    const P omega = at.load(m.omega);
    const P torque = at.load(varies ? batch.course.settled : m.torque);
    P theta = at.load(m.theta) + (omega * at.load(f.travel) + torque * at.load(f.push));
    P velocity = omega * at.load(f.decay) + torque * at.load(f.gain);
    if (varies) {
      const P lag = at.load(batch.course.lag);
      theta = theta + lag * at.load(f.lag_push);
      velocity = velocity + lag * at.load(f.lag_gain);
    }
    at.store(m.theta, theta);
    at.store(m.omega, velocity);
    at.store(batch.time.time_to_stop, P(0.0));
  });
}

/// The step of one vector; see loaded_free_kernel.
template <class At>
__attribute__((noinline)) void move_free_with_load(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  MotionLanes& m = batch.motion;
  const P zero(0.0);
  const P one(1.0);
  const P time_to_stop = at.load(batch.time.time_to_stop);
  const P omega = at.load(m.omega);
  const P per_inertia = at.load(batch.contact.per_inertia);
  const P h = without_short_remainder(min(at.load(batch.time.next_step), time_to_stop), time_to_stop);
  const P force_scale = h * h * per_inertia;
  const P damping_scale = at.load(batch.contact.damping) * h * per_inertia;
  ForcedTorque<P> applied;
  load_torque(batch, at, forcing, h, one, one, applied);
  P travel[batch_order + 1];
  P velocity[batch_order + 1];
  travel[0] = zero;
  velocity[0] = omega * h;
  P force = torque_on_rotor(batch, at, forcing, omega);
#pragma GCC unroll 1
  for (int k = 0; k < batch_order; ++k) {
    const P coefficient = applied.coefficient(k, velocity[k]);
    if (k > 0) force = coefficient;
    const P per_order(numerics::reciprocal.of[k + 1]);
    travel[k + 1] = velocity[k] * per_order;
    velocity[k + 1] = (force_scale * force - damping_scale * velocity[k]) * per_order;
  }
  VelocityStep<P> step =
      velocity_step(batch, at, time_to_stop, h,
                    (last_terms_of(travel) + last_terms_of(velocity)) + last_terms_of_load(applied));
  step.halts = one < zero;
  step.too_long = step.inexact;
  step.done = ~step.too_long;
  store_time(batch, at, step);
  at.store(m.theta, at.load(m.theta) + select(step.done, value_of(travel, batch_order, step.x), zero));
  at.store(m.omega, omega_after(step, velocity, omega));
  store_load(batch, at, applied, step.x, step.h, step.done);
  add_events(batch, at, events_where<P>(at.load(batch.time.steps) > P(max_steps_to_stop), beyond_kernel));
}

/// One step of each lane without friction and with a second mass: to the next stop, or as far as the series
/// converge. Reports beyond_kernel. See friction::NoFriction::step_coupled.
template <class V>
void loaded_free_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { move_free_with_load(batch, at, forcing); });
}

}  // namespace zerocount::batch
