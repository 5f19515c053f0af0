#pragma once

#include "core/batch/kernels/velocity_step.hpp"
#include "core/friction/sliding/slide_formulas.hpp"

namespace zerocount::batch {

/// Moves each lane without friction over one sample, to its next stop, by the exact linear map FreeLanes
/// (friction::free_motion).
/// @param varies whether the torque is CourseLanes::settled plus an exponentially decaying lag; otherwise it
/// is constant.
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

/// Integrates one step of one vector of lanes without friction and with a second mass; see
/// loaded_free_kernel().
template <class At>
__attribute__((noinline)) void move_free_with_load(BatchState& batch, const At& at, Forcing forcing) {
  using P = typename At::Vector;
  const P one(1.0);
  const P time_to_stop = at.load(batch.time.time_to_stop);
  const P omega = at.load(batch.motion.omega);
  const P h = without_short_remainder(min(at.load(batch.time.next_step), time_to_stop), time_to_stop);
  const P damping = at.load(batch.contact.damping) / h;
  ForcedTorque<P> applied;
  load_torque(batch, at, forcing, h, one, one, applied);
  struct {
    P position[batch_order + 1];
    P omega[batch_order + 1];
  } s;
  s.position[0] = P(0.0);
  s.omega[0] = omega * h;
  expand_motion(
      s, applied, h, torque_on_rotor(batch, at, forcing, omega),
      at.load(batch.contact.per_inertia), [&](std::size_t k, const P& u) __attribute__((always_inline)) {
        return friction::damped_coefficient(damping, s, k, u);
      });
  VelocityStep<P> step = velocity_step(batch, at, time_to_stop, h, last_terms_of(s, applied));
  step.halts = one < P(0.0);
  step.too_long = step.inexact;
  step.done = ~step.too_long;
  store_motion(batch, at, s, applied, omega, step);
  add_events(batch, at, lost_in_steps<P>(batch, at));
}

/// One integration step of each lane without friction and with a second mass. The step ends at the lane's
/// next stop (at which its torque may change), or where the Taylor series cease to be accurate. Reports
/// beyond_kernel for lanes that it cannot compute. See friction::NoFriction::step_coupled.
template <class V>
void loaded_free_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  for_each_group<typename V::Wide>(lanes, [&](const auto& at) { move_free_with_load(batch, at, forcing); });
}

}  // namespace zerocount::batch
