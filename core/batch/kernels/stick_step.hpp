#pragma once

#include "core/batch/kernels/coupled_torque.hpp"
#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/stick_series.hpp"

namespace zerocount::batch {

/// One integration step of a vector of lanes whose hook sticks: its start, its power series, and the part of
/// the step that is used.
template <class P>
struct StickStep {
  using Mask = typename P::Mask;

  Mask here;       ///< Lanes of the vector that take part in the step
  P h;             ///< Length of the full step, s
  P per_h;         ///< Reciprocal 1/h of the full step, 1/s
  P time_to_stop;  ///< Time from the start of the step to the lane's next stop, at which its torque may
                   ///< change, s
  P time_scale;    ///< Time scale 1/ωn of the contact's highest natural frequency, s
  P length;        ///< One unit of length in the series: −s/(softening rate), rad
  P torque_unit;   ///< One unit of StickSeries::scaled_torque: J/h²·length, N m

  // The start.
  P elongation_start;  ///< Spring elongation xs at the start of the step, rad
  P creep_start;       ///< Creep xh·sgn(σ) at the start of the step, rad
  P creep_limit;       ///< Growth of creep ±α·h/λ per |σ|ⁿ; 0 while creep is off
  Mask at_reversal;    ///< Mask of the lanes in which the elongation rate dxs/dt is zero at the start of the
                       ///< step
  Mask creeping;
  P torque_sign;       ///< Sign of the spring torque σ, ±1
  P direction;         ///< Direction in which the spring's elongation moves: −1, 0, 1
  P per_step;          ///< Damping per step, c/h: torque of the damper per ω·h, N m/rad
  P breakaway_torque;  ///< Torque Fs at which the hook starts to slide, N m
  P hook_torque;       ///< Torque σ + c·ω on the hook at the start of the step, N m
  StickLaw<P> law;
  StickSeries<P> series;

  // Step control.
  P forced_rate;  ///< Bound of the contribution of a varying torque to dxs/dt·h, divided by the softening
                  ///< length
  Mask reverses;  ///< The spring's elongation rate dxs/dt changes its sign within the step.
  Mask ends_at_reversal;  ///< The used step ends at the reversal of the spring's elongation.
  Mask too_long;
  Mask inexact;        ///< The step is too long because its truncation error exceeds `allowed_at_x`.
  P last_terms;        ///< Absolute value of the last two terms of the series of elongation and velocity,
                       ///< rad; estimates the truncation error
  P allowed;           ///< Truncation error allowed for the full step, rad
  P truncation_error;  ///< Truncation error at the fraction x of the step, rad
  P allowed_at_x;      ///< Truncation error allowed for the step up to x, rad
  P rate_start;  ///< Elongation rate dxs/dt·h at the start, or its slope if dxs/dt is zero there, divided by
                 ///< the softening length
  P rate_end;    ///< dxs/dt·h at the end of the full step, divided by the softening length

  // The part that is used.
  P x;                  ///< Fraction of the full step that is used, 0 to 1
  P event;              ///< Events (LaneEvent) at the end of the used step
  Mask has_event;       ///< Mask of the lanes whose step contains an event that this kernel does not locate
  Mask beyond;          ///< Mask of the lanes whose step the kernel cannot compute
  P torque;             ///< Spring torque σ at the end of the used step, N m
  P elongation_change;  ///< Change of the spring's elongation xs over the used step, rad
  P creep_change;       ///< Change of xh·sgn(σ), and of xp, over the used step, rad
  P creep_velocity;     ///< Rate of creep sgn(σ)·dxp/dt·h at the end of the used step, rad
  P velocity;           ///< Rotor velocity ω·h at the end of the used step, rad
};

/// The mask in which no lane is set.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask no_lanes() {
  return P(1.0) < P(0.0);
}

/// Series coefficient k of the rotor's ω·h, rad.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P velocity_coefficient(const StickStep<P>& step, int k) {
  const StickSeries<P>& s = step.series;
  if (k == batch_order) return step.length * s.rate[k];
  return step.length * (s.rate[k] + P(static_cast<double>(k + 1)) * s.scaled_creep[k + 1]);
}

/// Series coefficient k ≥ 1 of the spring's elongation xs, rad.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P elongation_coefficient(const StickStep<P>& step, int k) {
  return step.length * step.series.rate[k - 1] * P(numerics::reciprocal.of[k]);
}

/// Series coefficient k of the spring torque σ, N m.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P torque_coefficient(const StickStep<P>& step, int k) {
  return step.torque_unit * step.series.scaled_torque[k];
}

/// Chooses the length of the step, at most the time to the lane's next stop.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void begin_step(const BatchState& batch, const At& at, StickStep<P>& step) {
  const TimeLanes& time = batch.time;
  step.here = at.taking_part();
  step.time_to_stop = at.load(time.time_to_stop);
  step.time_scale = at.load(time.time_scale);
  step.at_reversal = to_mask(at.load(batch.motion.at_reversal));
  // The step must have at most one zero of dxs/dt; between two lies half a period of the stiffest spring.
  const P longest = step.time_scale * select(step.at_reversal, P(4.5), P(3.0));
  const P h = min(min(at.load(time.next_step), step.time_to_stop), longest);
  step.h = without_short_remainder(h, step.time_to_stop);
  step.per_h = P(1.0) / step.h;
}

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P allowed_error(const BatchState& batch, const At& at, const StickStep<P>& step);

/// The lanes in which torque ripples can be approximated by parabolas over a travel of at most `reach`: the
/// error is at most a tenth of the truncation error `allowed` (rad).
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask is_parabolic(const StickStep<P>& step,
                                                      const VaryingTorque<P>& ripples, const P& reach,
                                                      const P& allowed) {
  return ripples.cubic * (reach * reach * reach) * abs(step.length) <= P(0.1) * allowed * step.law.stiffness;
}

/// Computes the power series of a step under a varying torque or with a second mass. Torque ripples are
/// approximated by parabolas in the lanes whose travel is short enough.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void expand_forced(const BatchState& batch, const At& at, Forcing forcing,
                                           const StickStart<P>& start, const P& per_torque,
                                           ForcedTorque<P>& applied, StickStep<P>& step) {
  using Mask = typename P::Mask;
  VaryingTorque<P>& ripples = applied.alone;
  Mask parabolic = P(0.0) < P(1.0);
  for (;;) {
    load_torque(batch, at, forcing, step.h, per_torque, step.length, applied);
    if (forcing.varies) ripples.set_parabolic(parabolic);
    expand(step.law, start, applied, step.series);
    if (!forcing.varies || !ripples.has_parabolas) return;
    const Mask accurate = is_parabolic(step, ripples, ripples.reach, allowed_error(batch, at, step));
    const Mask failed = step.here & parabolic & ~accurate;
    if (!failed.any()) return;
    parabolic = parabolic & ~failed;  // the others keep their series
  }
}

template <class P, class At, class F, class Applied>
ZEROCOUNT_ALWAYS_INLINE void expand_step(const BatchState& batch, const At& at, F forcing, StickStep<P>& step,
                                         Applied& applied) {
  const MotionLanes& m = batch.motion;
  const ContactLanes& c = batch.contact;
  const P zero(0.0);
  const P h = step.h;
  const P per_inertia = at.load(c.per_inertia);
  const P damping = at.load(c.damping);
  const P torque = at.load(m.spring_torque);
  const P branch_sign = at.load(m.branch_sign);
  step.torque_sign = select(torque < zero, P(-1.0), P(1.0));
  step.creeping = to_mask(at.load(m.creeping));
  step.direction = at.load(m.direction);
  const P exponent = -branch_sign * at.load(m.branch_softening_rate);
  step.length = -branch_sign * at.load(m.branch_softening_length);
  step.torque_unit = at.load(c.inertia) * (step.per_h * step.per_h) * step.length;

  StickLaw<P>& law = step.law;
  const P acceleration = h * h * per_inertia;
  const P per_torque = exponent * acceleration;
  law.damping = damping * h * per_inertia;
  law.applied = per_torque * torque_on_rotor(batch, at, forcing, at.load(m.omega));
  law.stiffness = acceleration * at.load(c.k1);
  law.softening = per_torque * (branch_sign * at.load(m.branch_softening_torque));
  law.creep_recovery = select(step.creeping, at.load(c.alpha) * h, zero);
  law.creep_exponent = at.load(c.creep_exponent);
  step.creep_limit = step.torque_sign * law.creep_recovery * at.load(c.per_lambda);
  const P square_unit = step.torque_unit * step.torque_unit;
  law.creep_limit = exponent * step.creep_limit * select(law.creep_exponent == P(2.0), square_unit, P(1.0));

  step.elongation_start = at.load(m.elongation);
  step.creep_start = step.torque_sign * at.load(m.hardening);
  const P velocity = at.load(m.omega) * h;
  StickStart<P> start;
  start.scaled_creep = exponent * step.creep_start;
  start.velocity = exponent * velocity;
  start.scaled_torque = per_torque * torque;
  start.softness = at.load(m.softness);
  start.torque_power = at.load(m.torque_power);
  start.at_reversal = step.at_reversal;
  start.creeping = step.creeping & step.here;
  if constexpr (F::forced) {
    expand_forced(batch, at, forcing, start, per_torque, applied, step);
    step.forced_rate = P(4.0) * applied.change / law.stiffness;
  } else {
    expand(law, start, applied, step.series);
  }

  step.breakaway_torque = at.load(c.breakaway);
  step.per_step = damping * step.per_h;
  step.hook_torque = torque + step.per_step * velocity;
}

/// Whether the exponential of the branch grows too much for its series. It grows on an inward motion along a
/// virgin curve.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask grows_too_much(const BatchState& batch, const At& at,
                                                        const StickStep<P>& step) {
  const MotionLanes& m = batch.motion;
  const P branch_sign = at.load(m.branch_sign);
  const typename P::Mask inwards = step.direction * branch_sign < P(0.0);
  if (!(inwards & step.here).any()) return no_lanes<P>();
  P growth = abs(step.series.rate[0]);
#pragma GCC unroll 1
  for (int k = 1; k < batch_order; ++k) {
    growth = growth + abs(step.series.rate[k]) * P(numerics::reciprocal.of[k + 1]);
  }
  const P softening_rate = at.load(m.branch_softening_rate);
  const P travel = branch_sign * (step.elongation_start - at.load(m.branch_elongation));
  return inwards & (growth > P(6.0)) & (softening_rate * travel - growth < P(40.0));
}

/// The truncation error allowed in this step, rad. It is in proportion to the length of the step: h/T times
/// the lane's tolerance per torque step, or times a small fraction of the amplitude if the oscillation is
/// small.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P allowed_error(const BatchState& batch, const At& at, const StickStep<P>& step) {
  constexpr double of_amplitude = 4e-6;
  const TimeLanes& time = batch.time;
  const StickSeries<P>& s = step.series;
  const P ratio = step.time_scale * step.per_h;
  const P amplitude = abs(step.length) * (max(abs(s.rate[0]), abs(s.rate[1]) * ratio) * ratio);
  const P least = P(0.1) * at.load(time.rest);
  const P relative = P(of_amplitude) * max(amplitude, least);
  return min(at.load(time.tolerance), relative) * (step.h * at.load(time.sample_rate));
}

/// Mask of the lanes in which dxs/dt may have more zeros within the step than the signs at its ends show.
/// Creep may cause two zeros if dxs/dt is as small as creep's contribution to it, and a varying torque may do
/// so if dxs/dt is as small as that torque's contribution.
template <class P, class At, class F>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask may_reverse_twice(const BatchState& batch, const At& at, F forcing,
                                                           const StickStep<P>& step) {
  using Mask = typename P::Mask;
  const StickSeries<P>& s = step.series;
  // Order 1 of creep is order 0 of its rate.
  P added = at.load(batch.contact.max_creep_ratio) * abs(s.scaled_creep[1]);
  if (forcing.any()) added = added + step.forced_rate;
  Mask small = min(abs(step.rate_start), abs(step.rate_end)) <= added;
  if (forcing.any()) small = small & (added > P(0.0));  // not in a rotor that nothing moves
  Mask unsure = step.here & small;
  if (!forcing.any()) unsure = unsure & ~step.reverses;
  if (!unsure.any()) return unsure;
  P g[batch_order + 1];
  for (int k = 0; k < batch_order; ++k) g[k] = select(step.at_reversal, s.rate[k + 1], s.rate[k]);
  g[batch_order] = select(step.at_reversal, P(0.0), s.rate[batch_order]);
  const Mask may_reverse = ~keeps_sign(g[0], step.rate_end, g[1], curvature_bound(g, batch_order));
  if (!forcing.any()) return unsure & may_reverse;
  return unsure & ((step.reverses & ~crosses_once(g, batch_order)) | (~step.reverses & may_reverse));
}

/// Locates the reversal of the spring's elongation within the step, if any, and decides whether the step is
/// short enough to be accurate.
template <class P, class At, class F, class Applied>
ZEROCOUNT_ALWAYS_INLINE void find_reversal(const BatchState& batch, const At& at, F forcing,
                                           [[maybe_unused]] const Applied& applied, StickStep<P>& step) {
  using Mask = typename P::Mask;
  const StickSeries<P>& s = step.series;
  // Where dxs/dt is zero at the start, its next zero is that of (dxs/dt)/t.
  step.rate_end = sum_of(s.rate, batch_order);
  step.rate_start = select(step.at_reversal, s.rate[1], s.rate[0]);
  step.reverses = step.rate_start * step.rate_end < P(0.0);
  step.last_terms = abs(step.length) * s.last_terms;
  if constexpr (F::forced) step.last_terms = step.last_terms + last_terms_of_load(applied);
  step.allowed = allowed_error(batch, at, step);
  step.too_long = grows_too_much(batch, at, step) | may_reverse_twice(batch, at, forcing, step);
  const Mask seeks = step.here & step.reverses & ~step.too_long;
  step.x = P(1.0);
  // The series must be accurate only up to the reversal.
  step.truncation_error = step.last_terms;
  step.allowed_at_x = step.allowed;
  if (seeks.any()) {
    step.x =
        select(seeks, next_zero(s.rate, batch_order, step.rate_start, step.rate_end, step.at_reversal, seeks),
               P(1.0));
    const P square = step.x * step.x;
    const P fourth = square * square;
    // x to the power of the order − 1
    static_assert(batch_order == 14);
    step.truncation_error = step.truncation_error * (fourth * fourth) * fourth * step.x;
    step.allowed_at_x = step.allowed * step.x;
  }
  step.ends_at_reversal = seeks;
  step.inexact = ~(step.truncation_error <= step.allowed_at_x);
  step.too_long = step.too_long | step.inexact;
}

/// Ends the used step at its fraction `x` in the lanes of `where`: evaluates the state there, except the
/// velocity.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void end_at(const P& x, const typename P::Mask& where, StickStep<P>& step) {
  const StickSeries<P>& s = step.series;
  P torque = s.scaled_torque[batch_order];
  P elongation = s.rate[batch_order - 1] * P(numerics::reciprocal.of[batch_order]);
  P creep = s.scaled_creep[batch_order];
#pragma GCC unroll 1
  for (int k = batch_order - 1; k >= 1; --k) {
    torque = torque * x + s.scaled_torque[k];
    elongation = elongation * x + s.rate[k - 1] * P(numerics::reciprocal.of[k]);
    creep = creep * x + s.scaled_creep[k];
  }
  step.x = select(where, x, step.x);
  step.torque = select(where, step.torque_unit * (torque * x + s.scaled_torque[0]), step.torque);
  step.elongation_change = select(where, step.length * (elongation * x), step.elongation_change);
  step.creep_change = select(where, step.length * (creep * x), step.creep_change);
}

/// Computes the rate of creep at the end of the used step (creep_velocity).
template <class P>
ZEROCOUNT_ALWAYS_INLINE void evaluate_creep(StickStep<P>& step) {
  P power = step.torque * step.torque;
  const typename P::Mask other_powers = step.creeping & (step.law.creep_exponent != P(2.0));
  if (other_powers.any()) {
    power = select(other_powers, pow(abs(step.torque), step.law.creep_exponent), power);
  }
  step.creep_velocity =
      step.creep_limit * power - step.law.creep_recovery * (step.creep_start + step.creep_change);
}

/// Computes the state of motion at the end of the used step.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void evaluate_end(StickStep<P>& step) {
  const StickSeries<P>& s = step.series;
  step.torque = step.torque_unit * s.scaled_torque_end;
  step.elongation_change = step.length * s.elongation_change;
  step.creep_change = step.length * s.creep_change;
  if (step.ends_at_reversal.any()) end_at(step.x, step.ends_at_reversal, step);
  evaluate_creep(step);
  // At a reversal only creep moves the rotor.
  step.velocity = select(step.ends_at_reversal, step.creep_velocity, step.length * s.velocity_end);
}

}  // namespace zerocount::batch
