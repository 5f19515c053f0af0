#pragma once

#include "core/batch/lane_group.hpp"
#include "core/batch/stick_series.hpp"

namespace zerocount::batch {

/// A step of the lanes of one vector: where it begins, its series, and the part of it that is taken.
template <class P>
struct StickStep {
  using Mask = typename P::Mask;

  Mask here;       ///< the lanes that take part
  P h;             ///< length, s
  P per_length;    ///< 1/h, 1/s
  P time_to_stop;  ///< left to the next stop, s
  P longest_step;  ///< 1/ωn, s
  P torque_scale;  ///< J/h²: σ by the series' pull

  // The start.
  Mask turning;  ///< dxs/dt is zero
  Mask creeping;
  P torque_sign;  ///< of σ
  P direction;    ///< of the elongation
  P per_step;     ///< c/h: damper's torque by ω·h, N m/rad
  P breakaway;    ///< N m
  P hook_torque;  ///< σ + c·ω, N m
  StickLaw<P> law;
  StickSeries<P> series;

  // How long a step the series allows.
  Mask reverses;      ///< dxs/dt changes its sign
  Mask reverses_too;  ///< of them, those whose reversal is to be found
  Mask too_long;
  Mask inexact;    ///< too long, because of the terms left out
  P last_terms;    ///< of elongation and velocity, rad
  P allowed;       ///< limit of last_terms, rad
  P left_out;      ///< last_terms at x
  P allowed_at_x;  ///< `allowed` for the part of the step up to x, rad
  P rate_end;      ///< of dxs/dt·h at the whole step, rad

  // The step that is taken.
  P x;         ///< the fraction of the full step that is used
  P event;     ///< LaneEvent at the end of it
  Mask meets;  ///< it has an event that this kernel does not look for
  Mask beyond;
  P torque, elongation, growth;  ///< σ, xs and xh·sgn(σ) at its end
  P creep, velocity;             ///< dxp/dt·h and ω·h at its end
};

template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask nowhere() {
  return P(1.0) < P(0.0);
}

/// The step that is thought to be good, at most to the next stop.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void begin_step(const BatchState& batch, const At& at, StickStep<P>& step) {
  const TimeLanes& time = batch.time;
  step.here = at.taking_part();
  step.time_to_stop = at.load(time.time_to_stop);
  step.longest_step = at.load(time.longest_step);
  step.turning = to_mask(at.load(batch.motion.turning));
  // Half a period of the stiffest spring lies between two zeros of dxs/dt. Of these there must be one at
  // most.
  const P longest = step.longest_step * select(step.turning, P(4.5), P(3.0));
  const P h = min(min(at.load(time.next_step), step.time_to_stop), longest);
  step.h = select((h < step.time_to_stop) & (step.time_to_stop < P(1.4) * h), step.time_to_stop * P(0.5), h);
  step.per_length = P(1.0) / step.h;
}

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void expand_step(const BatchState& batch, const At& at, StickStep<P>& step) {
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
  step.torque_scale = at.load(c.inertia) * (step.per_length * step.per_length);

  StickLaw<P>& law = step.law;
  const P by_torque = h * h * per_inertia;
  law.damping = damping * h * per_inertia;
  law.applied = by_torque * at.load(m.torque);
  law.stiffness = by_torque * at.load(c.k1);
  law.softening = by_torque * (branch_sign * at.load(m.branch_softening_torque));
  law.exponent = -branch_sign * at.load(m.branch_softening_rate);
  law.creep_recovery = select(step.creeping, at.load(c.alpha) * h, zero);
  law.creep_exponent = at.load(c.creep_exponent);
  const P creep_limit = step.torque_sign * law.creep_recovery * at.load(c.per_lambda);
  const P squared_scale = step.torque_scale * step.torque_scale;
  law.creep_limit = creep_limit * select(law.creep_exponent == P(2.0), squared_scale, P(1.0));

  StickStart<P> start;
  start.elongation = at.load(m.elongation);
  start.growth = step.torque_sign * at.load(m.hardening);
  start.velocity = at.load(m.omega) * h;
  start.pull = by_torque * torque;
  start.softness = at.load(m.softness);
  start.torque = torque;
  start.turning = step.turning;
  start.creeping = step.creeping & step.here;
  expand(law, start, step.series);

  step.breakaway = at.load(c.breakaway);
  step.per_step = damping * step.per_length;
  step.hook_torque = torque + step.per_step * start.velocity;
}

/// The rate of creep at the end of the step, by its law.
/// @param pull σ·h²/J there, rad.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void see_creep(StickStep<P>& step, const P& pull) {
  P power = pull * pull;
  const typename P::Mask other_powers = step.creeping & (step.law.creep_exponent != P(2.0));
  if (other_powers.any()) {
    power = select(other_powers, pow(abs(step.torque), step.law.creep_exponent), power);
  }
  step.creep = step.law.creep_limit * power - step.law.creep_recovery * step.growth;
}

/// Inwards along a virgin curve the exponential grows, and must not by many e-folds.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask grows_too_much(const BatchState& batch, const At& at,
                                                        const StickStep<P>& step) {
  const MotionLanes& m = batch.motion;
  const P branch_sign = at.load(m.branch_sign);
  const typename P::Mask inwards = step.direction * branch_sign < P(0.0);
  if (!(inwards & step.here).any()) return nowhere<P>();
  const P softening_rate = at.load(m.branch_softening_rate);
  const P growth = softening_rate * reach_bound(step.series.elongation, batch_order);
  const P travelled = branch_sign * (step.series.elongation[0] - at.load(m.branch_elongation));
  return inwards & (growth > P(6.0)) & (softening_rate * travelled - growth < P(40.0));
}

/// The truncation error allowed in this step. An oscillation of less than 5e-6 count is followed to 2e-6 of
/// its amplitude.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P allowed_error(const BatchState& batch, const At& at, const StickStep<P>& step) {
  const TimeLanes& time = batch.time;
  const StickSeries<P>& s = step.series;
  const P ratio = step.longest_step * step.per_length;
  const P amplitude = max(abs(s.rate[0]), abs(s.rate[1]) * ratio) * ratio;
  const P scale = min(max(amplitude * at.load(time.per_count) * P(2e5), P(1e-3)), P(1.0));
  return at.load(time.tolerance) * scale * (step.h * at.load(time.sample_rate));
}

/// Whether dxs/dt, which has the same sign at both ends, may be zero between them: where it is as small as
/// the contribution of creep, that may bring it through zero and back.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask may_turn_twice(const BatchState& batch, const At& at,
                                                        const StickStep<P>& step, const P& rate_start) {
  using Mask = typename P::Mask;
  const StickSeries<P>& s = step.series;
  const P creep_velocity = at.load(batch.contact.creep_acceleration) * abs(creep_coefficient(s, 0));
  const Mask small = min(abs(rate_start), abs(step.rate_end)) <= creep_velocity;
  const Mask unsure = step.here & ~step.reverses & small;
  if (!unsure.any()) return unsure;
  P g[batch_order + 1];
  for (int k = 0; k < batch_order; ++k) g[k] = select(step.turning, s.rate[k + 1], s.rate[k]);
  g[batch_order] = select(step.turning, P(0.0), s.rate[batch_order]);
  return unsure & ~cannot_turn(g[0], step.rate_end, g[1], curvature_bound(g, batch_order));
}

/// Finds the reversal, if there is one, and whether the step is short enough for the series to tell.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void find_reversal(const BatchState& batch, const At& at, StickStep<P>& step) {
  using Mask = typename P::Mask;
  const StickSeries<P>& s = step.series;
  // Where dxs/dt is zero at the start, its next zero is that of (dxs/dt)/t.
  step.rate_end = sum_of(s.rate, batch_order);
  const P rate_start = select(step.turning, s.rate[1], s.rate[0]);
  step.reverses = rate_start * step.rate_end < P(0.0);
  step.last_terms = (abs(s.elongation[batch_order - 1]) + abs(s.velocity[batch_order - 1])) +
                    (abs(s.elongation[batch_order]) + abs(s.velocity[batch_order]));
  step.allowed = allowed_error(batch, at, step);
  step.too_long = grows_too_much(batch, at, step) | may_turn_twice(batch, at, step, rate_start);
  const Mask seeks = step.here & step.reverses & ~step.too_long;
  step.x = P(1.0);
  // With a reversal the series has to be accurate up to there only.
  step.left_out = step.last_terms;
  step.allowed_at_x = step.allowed;
  if (seeks.any()) {
    step.x =
        select(seeks, next_zero(s.rate, batch_order, rate_start, step.rate_end, step.turning, seeks), P(1.0));
    const P square = step.x * step.x;
    const P fourth = square * square;
    // x to the power of the order − 1
    static_assert(batch_order == 14);
    step.left_out = step.left_out * (fourth * fourth) * fourth * step.x;
    step.allowed_at_x = step.allowed * step.x;
  }
  step.reverses_too = seeks;
  step.inexact = ~(step.left_out <= step.allowed_at_x);
  step.too_long = step.too_long | step.inexact;
}

/// The motion at the end of the part that is used.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void evaluate_end(StickStep<P>& step) {
  const StickSeries<P>& s = step.series;
  P pull;
  if (step.reverses_too.any()) {
    P value[3];
    values_of(s.pull, s.elongation, s.growth, batch_order, step.x, value);
    pull = value[0];
    step.elongation = value[1];
    step.growth = value[2];
  } else {
    pull = sum_of(s.pull, batch_order);
    step.elongation = sum_of(s.elongation, batch_order);
    step.growth = sum_of(s.growth, batch_order);
  }
  step.torque = pull * step.torque_scale;
  see_creep(step, pull);
  // At a reversal only creep moves the rotor.
  step.velocity = select(step.reverses_too, step.creep, sum_of(s.velocity, batch_order));
}

}  // namespace zerocount::batch
