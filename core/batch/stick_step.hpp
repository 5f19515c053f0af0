#pragma once

#include "core/batch/lane_group.hpp"
#include "core/batch/stick_series.hpp"

namespace zerocount::batch {

/// A step of the lanes of one pack: where it begins, its series, and what is made of it.
template <class P>
struct StickStep {
  using Mask = typename P::Mask;

  Mask here;       ///< the lanes that take part
  P h;             ///< length, s
  P time_to_stop;  ///< left to the next stop, s

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
  P torque, elongation, velocity, growth;  ///< σ, xs, ω·h and xh·sgn(σ) at its end
};

template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask nowhere() {
  return P(1.0) < P(0.0);
}

/// The step that is thought to be good, at most to the next stop.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void begin_step(const BatchState& batch, const LaneGroup<P>& at, StickStep<P>& step) {
  const TimeLanes& time = batch.time;
  step.here = at.taking_part();
  step.time_to_stop = at.load(time.time_to_stop);
  step.turning = to_mask(at.load(batch.motion.turning));
  // Half a period of the stiffest spring lies between two zeros of dxs/dt. Of these there must be one at
  // most.
  const P longest = at.load(time.longest_step) * select(step.turning, P(4.5), P(3.0));
  const P h = min(min(at.load(time.next_step), step.time_to_stop), longest);
  step.h = select((h < step.time_to_stop) & (step.time_to_stop < P(1.4) * h), step.time_to_stop * P(0.5), h);
}

template <class P>
ZEROCOUNT_ALWAYS_INLINE void expand_step(const BatchState& batch, const LaneGroup<P>& at,
                                         StickStep<P>& step) {
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

  StickLaw<P>& law = step.law;
  law.acceleration = h * h * per_inertia;
  law.damping = damping * h * per_inertia;
  law.applied = at.load(m.torque);
  law.k1 = at.load(c.k1);
  law.softening = branch_sign * at.load(m.branch_softening_torque);
  law.exponent = -branch_sign * at.load(m.branch_softening_rate);
  law.creep_recovery = select(step.creeping, at.load(c.alpha) * h, zero);
  law.creep_limit = step.torque_sign * law.creep_recovery * at.load(c.per_lambda);
  law.creep_exponent = at.load(c.creep_exponent);
  StickSeries<P>& s = step.series;
  s.elongation[0] = at.load(m.elongation);
  s.velocity[0] = at.load(m.omega) * h;
  s.growth[0] = step.torque_sign * at.load(m.hardening);
  s.torque[0] = torque;
  expand(law, at.load(m.softness), step.turning, step.creeping & step.here, s);

  step.breakaway = at.load(c.breakaway);
  step.per_step = damping / h;
  step.hook_torque = torque + step.per_step * s.velocity[0];
}

/// Inwards along a virgin curve the exponential grows, and must not by many e-folds.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask grows_too_much(const BatchState& batch, const LaneGroup<P>& at,
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
template <class P>
ZEROCOUNT_ALWAYS_INLINE P allowed_error(const BatchState& batch, const LaneGroup<P>& at,
                                        const StickStep<P>& step) {
  const TimeLanes& time = batch.time;
  const StickSeries<P>& s = step.series;
  const P ratio = at.load(time.longest_step) / step.h;
  const P amplitude = max(abs(s.rate[0]), abs(s.rate[1]) * ratio) * ratio;
  const P scale = min(max(amplitude * at.load(time.per_count) * P(2e5), P(1e-3)), P(1.0));
  return at.load(time.tolerance) * scale * (step.h * at.load(time.sample_rate));
}

/// Finds the reversal, if there is one, and whether the step is short enough for the series to tell.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void find_reversal(const BatchState& batch, const LaneGroup<P>& at,
                                           StickStep<P>& step) {
  using Mask = typename P::Mask;
  const StickSeries<P>& s = step.series;
  const P zero(0.0);
  // Where dxs/dt is zero at the start, its next zero is that of (dxs/dt)/t.
  step.rate_end = sum_of(s.rate, batch_order - 1);
  const P rate_start = select(step.turning, s.rate[1], s.rate[0]);
  step.reverses = rate_start * step.rate_end < zero;
  step.last_terms = (abs(s.elongation[batch_order - 1]) + abs(s.velocity[batch_order - 1])) +
                    (abs(s.elongation[batch_order]) + abs(s.velocity[batch_order]));
  step.allowed = allowed_error(batch, at, step);
  step.too_long = grows_too_much(batch, at, step);
  // Where dxs/dt is as small as the contribution of creep, that may bring it through zero and back.
  const P creep_velocity =
      P(8.0) * at.load(batch.contact.alpha) * at.load(batch.contact.damping) / step.law.k1 * abs(s.creep[0]);
  const Mask unsure =
      step.here & ~step.reverses & (min(abs(rate_start), abs(step.rate_end)) <= creep_velocity);
  const Mask seeks = step.here & step.reverses & ~step.too_long;
  step.x = P(1.0);
  // With a reversal the series has to be accurate up to there only.
  step.left_out = step.last_terms;
  step.allowed_at_x = step.allowed;
  if ((seeks | unsure).any()) {
    P g[batch_order];
    for (int k = 0; k < batch_order - 1; ++k) g[k] = select(step.turning, s.rate[k + 1], s.rate[k]);
    g[batch_order - 1] = select(step.turning, zero, s.rate[batch_order - 1]);
    if (unsure.any()) {
      const P curvature = curvature_bound(g, batch_order - 1);
      step.too_long = step.too_long | (unsure & ~cannot_turn(g[0], step.rate_end, g[1], curvature));
    }
    if (seeks.any()) {
      step.x = select(seeks, root_between(g, batch_order - 1, g[0], step.rate_end, P(1.0), seeks), P(1.0));
#pragma GCC unroll 1
      for (int k = 1; k < batch_order; ++k) step.left_out = step.left_out * step.x;
      step.allowed_at_x = step.allowed * step.x;
    }
  }
  step.reverses_too = seeks;
  step.inexact = ~(step.left_out <= step.allowed_at_x);
  step.too_long = step.too_long | step.inexact;
}

/// The motion at the end of the part that is used.
template <class P>
ZEROCOUNT_ALWAYS_INLINE void evaluate_end(StickStep<P>& step) {
  const StickSeries<P>& s = step.series;
  if (step.reverses_too.any()) {
    P value[4];
    values_of(s.torque, s.elongation, s.velocity, s.growth, batch_order, step.x, value);
    step.torque = value[0];
    step.elongation = value[1];
    step.velocity = value[2];
    step.growth = value[3];
  } else {
    step.torque = sum_of(s.torque, batch_order);
    step.elongation = sum_of(s.elongation, batch_order);
    step.velocity = sum_of(s.velocity, batch_order);
    step.growth = sum_of(s.growth, batch_order);
  }
}

}  // namespace zerocount::batch
