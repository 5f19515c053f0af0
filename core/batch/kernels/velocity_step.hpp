#pragma once

#include "core/batch/kernels/coupled_torque.hpp"
#include "core/batch/kernels/lane_group.hpp"
#include "core/friction/sliding/slide_formulas.hpp"

/// Integration steps of motions without a sticking hook: sliding hooks, bristles, Maxwell-slip elements, and
/// rotors without friction. The series of such a motion has `position`, the travel since the start of the
/// step (rad), and `omega`, ω·h.
namespace zerocount::batch {

/// Length (s), at most `longest`, of a step of a motion far above the Stribeck velocity that decelerates by
/// at most `slowing` (rad/s²). The step ends where the Stribeck curve begins to matter.
/// @param speed |ω|, rad/s.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P fast_step(const P& speed, const P& stribeck_velocity, const P& slowing,
                                    const P& longest) {
  const P above = speed - P(friction::slow_by_stribeck_velocity) * stribeck_velocity;
  return select(slowing * longest > above, above / slowing, longest);
}

/// Length (s) of a step in which (ω/ωs)² changes by about 4; more at velocities far above the Stribeck
/// velocity ωs, where exp(−(ω/ωs)²) is negligible.
/// @param acceleration absolute acceleration of the rotor, rad/s².
template <class P>
ZEROCOUNT_ALWAYS_INLINE P stribeck_step(const P& omega, const P& acceleration, const P& stribeck_velocity,
                                        const P& per_velocity_squared) {
  const P changing = acceleration * (abs(omega) + P(2.0) * stribeck_velocity) * per_velocity_squared;
  const P far = per_velocity_squared * omega * omega;
  return max(P(4.0), P(0.5) * (far - P(23.0))) / changing;
}

/// Whether exp(−(ω/ωs)²) may grow too much within the step for its power series to be accurate.
/// @param exponent series of −(ω/ωs)².
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask grows_too_much(const P* exponent) {
  P growth = max(exponent[batch_order - 1], P(0.0));
#pragma GCC unroll 1
  for (int k = batch_order - 2; k >= 1; --k) growth = growth + max(exponent[k], P(0.0));
  return growth > max(P(6.0), P(-23.0) - exponent[0]);
}

/// Whether a fast motion surely stays above the velocity at which the Stribeck curve begins to matter,
/// throughout a step of h (s). It must be above that velocity at the start.
/// @param velocity the series of ω·h.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask stays_fast(const P* velocity, const P& stribeck_velocity,
                                                    const P& h) {
  const P slow = P(friction::slow_by_stribeck_velocity) * stribeck_velocity * h;
  const P direction = sign(velocity[0]);
  const P above_end = direction * sum_of(velocity, batch_order) - slow;
  return (above_end > P(0.0)) & keeps_sign(direction * velocity[0] - slow, above_end, direction * velocity[1],
                                           curvature_bound(velocity, batch_order));
}

/// Sum of the absolute values of the last two terms of a series at the end of the step; estimates its
/// truncation error.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P last_terms_of(const P* c) {
  return abs(c[batch_order - 1]) + abs(c[batch_order]);
}

/// A step of a motion without a sticking hook, and its step control.
template <class P>
struct VelocityStep {
  using Mask = typename P::Mask;
  P time_to_stop;      ///< Time from the start of the step to the lane's next stop, at which its torque may
                       /// < change, s
  P h;                 ///< Length of the full step, s
  P x;                 ///< Fraction of the full step that is used, 0 to 1
  P truncation_error;  ///< Estimate of the truncation error, rad
  P allowed;           ///< Largest truncation error allowed, rad
  Mask inexact;        ///< Mask of the lanes whose truncation error exceeds the error allowed
  Mask too_long;       ///< The step is inexact, or too long for another reason; nothing moves.
  Mask done;           ///< Mask of the lanes whose motion advances to x
  Mask halts;          ///< Mask of the lanes in which the velocity ω is 0 at x
};

/// Expands a motion into power series in the fraction of a step of length h (s), as motion::motion_series
/// does in time.
/// @param torque torque on the rotor at the start, N m.
/// @param per_inertia 1/J.
/// @param law friction law: receives coefficient k of the torque on the rotor, computes its own coefficients
/// k, and returns coefficient k of the torque that accelerates the rotor.
template <class P, class Series, class Applied, class Law>
ZEROCOUNT_ALWAYS_INLINE void expand_motion(Series& s, Applied& applied, const P& h, const P& torque,
                                           const P& per_inertia, Law law) {
  const P acceleration = h * h * per_inertia;
#pragma GCC unroll 1
  for (int k = 0; k < batch_order; ++k) {
    const P varying = applied.coefficient(k, s.omega[k]);
    const P force = law(static_cast<std::size_t>(k), k == 0 ? torque : varying);
    s.omega[k + 1] = force * acceleration * P(numerics::reciprocal.of[k + 1]);
  }
}

/// Sum of the absolute values of the last two terms of the series of a motion, and of its second mass, at the
/// end of the step; estimates the truncation error.
template <class Series, class Applied>
ZEROCOUNT_ALWAYS_INLINE auto last_terms_of(const Series& s, const Applied& applied) {
  const auto of_rotor = last_terms_of(s.position) + last_terms_of(s.omega);
  if constexpr (!Applied::forced)
    return of_rotor;
  else
    return of_rotor + last_terms_of_load(applied);
}

/// Creates a step whose full length h (s) is used, and marks it as too long where the truncation error (rad)
/// exceeds the error allowed.
/// @param time_to_stop time to the lane's next stop, s.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE VelocityStep<P> velocity_step(const BatchState& batch, const At& at,
                                                      const P& time_to_stop, const P& h,
                                                      const P& truncation_error) {
  VelocityStep<P> step;
  step.time_to_stop = time_to_stop;
  step.h = h;
  step.x = P(1.0);
  step.truncation_error = truncation_error;
  step.allowed = at.load(batch.time.tolerance) * (h * at.load(batch.time.sample_rate));
  step.inexact = ~(truncation_error <= step.allowed);
  return step;
}

/// Sets step.halts in the lanes whose velocity ω comes to 0 within the step.
/// @returns the lanes in which that is uncertain, because ω may have two zeros within the step (or ω/t, if ω
/// starts at 0).
/// @param velocity series of ω·h.
/// @param careful whether to check also the lanes in which the signs at both ends differ.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask halts_unsurely(const P* velocity, bool careful,
                                                        VelocityStep<P>& step) {
  const auto from_zero = velocity[0] == P(0.0);
  P part[batch_order + 1];
  for (int k = 0; k < batch_order; ++k) part[k] = select(from_zero, velocity[k + 1], velocity[k]);
  part[batch_order] = select(from_zero, P(0.0), velocity[batch_order]);
  const P at_end = sum_of(velocity, batch_order);
  const P curvature = curvature_bound(part, batch_order);
  step.halts = part[0] * at_end < P(0.0);
  auto unsure = ~step.halts & ~keeps_sign(part[0], at_end, part[1], curvature);
  if (!careful) return unsure;
  unsure = unsure | (step.halts & ~crosses_once(part, batch_order));
  // A rotor that nothing moves keeps still.
  return unsure & ((curvature > P(0.0)) | (part[1] != P(0.0)));
}

/// Ends the step at the instant at which the velocity ω comes to 0, unless the step is too long.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void end_at_halt(const P* velocity, const At& at, VelocityStep<P>& step) {
  const auto seeks = at.taking_part() & step.halts & ~step.too_long;
  if (!seeks.any()) return;
  const auto from_zero = velocity[0] == P(0.0);
  const P halt = next_zero(velocity, batch_order, select(from_zero, velocity[1], velocity[0]),
                           sum_of(velocity, batch_order), from_zero, seeks);
  step.x = select(step.halts, halt, P(1.0));
}

/// Velocity ω at the end of the step, rad/s.
/// @param velocity the series of ω·h.
/// @param omega ω at the start of the step, rad/s.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P omega_after(const VelocityStep<P>& s, const P* velocity, const P& omega) {
  return select(s.done, select(s.halts, P(0.0), value_of(velocity, batch_order, s.x) / s.h), omega);
}

/// Stores the time from the end of the step to the lane's next stop, and the length of the next step to try.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void store_time(BatchState& batch, const At& at, const VelocityStep<P>& s) {
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P factor = P(0.9) * rough_power(s.allowed, s.truncation_error, 1.0 / batch_order);
  const P shorter = shorter_step(s.h, s.inexact, factor);
  const P longer = s.h * min(max(factor, P(0.3)), P(4.0));
  at.store(time.next_step, select(s.too_long, shorter, select(s.done, longer, s.h)));
  const auto stops_here = s.done & (s.x == P(1.0)) & ~(s.h < s.time_to_stop);
  at.store(time.time_to_stop,
           select(stops_here, zero, select(s.done, s.time_to_stop - s.x * s.h, s.time_to_stop)));
  at.store(time.steps, at.load(time.steps) + P(1.0));
}

/// Stores rotor angle, velocity and second mass at the end of the step.
/// @param omega velocity ω at the start of the step, rad/s.
template <class P, class At, class Series, class Applied>
ZEROCOUNT_ALWAYS_INLINE void store_motion(BatchState& batch, const At& at, const Series& s,
                                          const Applied& applied, const P& omega,
                                          const VelocityStep<P>& step) {
  MotionLanes& m = batch.motion;
  store_time(batch, at, step);
  const P travel = value_of(s.position, batch_order, step.x);
  at.store(m.theta, at.load(m.theta) + select(step.done, travel, P(0.0)));
  at.store(m.omega, omega_after(step, s.omega, omega));
  if constexpr (Applied::forced) store_load(batch, at, applied, step.x, step.h, step.done);
}

/// The event beyond_kernel in the lanes that have made more than max_steps_to_stop steps since the last
/// sample; 0 in the others.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P lost_in_steps(const BatchState& batch, const At& at) {
  return events_where<P>(at.load(batch.time.steps) > P(max_steps_to_stop), beyond_kernel);
}

}  // namespace zerocount::batch
