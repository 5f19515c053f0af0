#pragma once

#include "core/batch/kernels/applied_torque.hpp"
#include "core/batch/kernels/step_control.hpp"
#include "core/friction/sliding/stribeck_series.hpp"

/// Step control of motions whose friction is a function of the velocity: slides and bristles.
namespace zerocount::batch {

/// The step (s), at most `longest`, of a fast motion that decelerates by at most `slowing` (rad/s²): it ends
/// where the Stribeck curve begins to matter.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P fast_step(const P& speed, const P& stribeck_velocity, const P& slowing,
                                    const P& longest) {
  const P above = speed - P(friction::slow_by_stribeck_velocity) * stribeck_velocity;
  return select(slowing * longest > above, above / slowing, longest);
}

/// The step (s) in which (ω/ωs)² changes by about 4, or far above the Stribeck velocity, where its
/// exponential is negligible, by more. @param acceleration its absolute value, rad/s².
template <class P>
ZEROCOUNT_ALWAYS_INLINE P stribeck_step(const P& omega, const P& acceleration, const P& stribeck_velocity,
                                        const P& per_velocity_squared) {
  const P changing = acceleration * (abs(omega) + P(2.0) * stribeck_velocity) * per_velocity_squared;
  const P far = per_velocity_squared * omega * omega;
  return max(P(4.0), P(0.5) * (far - P(23.0))) / changing;
}

/// Whether exp(−(ω/ωs)²) may grow too much within the step for its series.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask grows_too_much(const P* exponent) {
  P growth = max(exponent[batch_order - 1], P(0.0));
#pragma GCC unroll 1
  for (int k = batch_order - 2; k >= 1; --k) growth = growth + max(exponent[k], P(0.0));
  return growth > max(P(6.0), P(-23.0) - exponent[0]);
}

/// Whether a motion that starts faster than that surely stays above the velocity at which the Stribeck curve
/// begins to matter throughout a step of h (s). @param velocity the series of ω·h.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask stays_fast(const P* velocity, const P& stribeck_velocity,
                                                    const P& h) {
  const P slow = P(friction::slow_by_stribeck_velocity) * stribeck_velocity * h;
  const P direction = sign(velocity[0]);
  const P above_end = direction * sum_of(velocity, batch_order) - slow;
  return (above_end > P(0.0)) & keeps_sign(direction * velocity[0] - slow, above_end, direction * velocity[1],
                                           curvature_bound(velocity, batch_order));
}

/// The sum of the last two terms of a series at the end of the step.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P last_terms_of(const P* c) {
  return abs(c[batch_order - 1]) + abs(c[batch_order]);
}

/// A step and its control.
template <class P>
struct VelocityStep {
  using Mask = typename P::Mask;
  P time_to_stop;      ///< at its start, s
  P h;                 ///< s
  P x;                 ///< fraction of the step that is used
  P truncation_error;  ///< truncation error, rad
  P allowed;           ///< largest truncation error, rad
  Mask inexact;        ///< truncation_error > allowed
  Mask too_long;       ///< for this or another reason: nothing moves
  Mask done;           ///< the motion goes on to x
  Mask halts;          ///< ω is 0 at x
};

/// A step of h (s) with its truncation error (rad), up to its end.
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

/// ω at the end of the step, rad/s. @param velocity the series of ω·h. @param omega at the start.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P omega_after(const VelocityStep<P>& s, const P* velocity, const P& omega) {
  return select(s.done, select(s.halts, P(0.0), value_of(velocity, batch_order, s.x) / s.h), omega);
}

/// Stores the time to the next stop after the step, and the length of the next one.
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

}  // namespace zerocount::batch
