#pragma once

#include "core/batch/stick_step.hpp"

namespace zerocount::batch {

/// xs at the end of the step, rad.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P elongation_end(const StickStep<P>& step) {
  return step.elongation_start + step.elongation_change;
}

/// Events whose threshold is passed at the end of a step.
template <class P>
struct EventsPassed {
  using Mask = typename P::Mask;
  Mask closes;     ///< the branch has ended
  Mask creep_off;  ///< creep has reached its limit, or σ zero
  Mask creep_on;   ///< |σ| has passed the onset of creep
};

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE EventsPassed<P> events_passed(const BatchState& batch, const At& at,
                                                      const StickStep<P>& step) {
  const P zero(0.0);
  const P creep_left = step.torque_sign * step.creep_velocity;
  return {step.direction * (elongation_end(step) - at.load(batch.motion.branch_end)) >= zero,
          step.creeping & (~(creep_left > zero) | (step.torque_sign * step.torque <= zero)),
          ~step.creeping & (abs(step.torque) >= at.load(batch.motion.creep_onset))};
}

/// Coefficient k of the hook's torque, N m.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P hook_coefficient(const StickStep<P>& step, int k) {
  return torque_coefficient(step, k) + step.per_step * velocity_coefficient(step, k);
}

/// σ + c·ω at the end of the step, N m.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P hook_torque_at_end(const StickStep<P>& step) {
  return step.torque + step.per_step * step.velocity;
}

/// Whether the hook's torque may reach the breakaway torque within the step. @param at_ends its larger value
/// at the ends, N m.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask may_slip_within(const StickStep<P>& step, const P& at_ends) {
  P hook[batch_order + 1];
  for (int k = 0; k <= batch_order; ++k) hook[k] = hook_coefficient(step, k);
  const P curvature = curvature_bound(hook, batch_order);
  return (at_ends + curvature * P(0.125) >= step.breakaway_torque) & ~(abs(hook[1]) > curvature);
}

/// Marks the lanes whose steps have an event other than a reversal, without locating it.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void mark_events(const BatchState& batch, const At& at, StickStep<P>& step) {
  using Mask = typename P::Mask;
  const EventsPassed<P> passed = events_passed(batch, at, step);
  const P hook_max = max(abs(step.hook_torque), abs(hook_torque_at_end(step)));
  Mask slips = hook_max >= step.breakaway_torque;
  const Mask near = ~step.too_long & (hook_max > P(0.5) * step.breakaway_torque);
  if ((near & step.here).any()) slips = slips | (near & may_slip_within(step, hook_max));
  step.meets = ~step.too_long & (passed.closes | passed.creep_off | passed.creep_on | slips);
  step.beyond = no_lanes<P>();
}

/// The event that each lane locates. At most one of the masks is set.
template <class P>
struct SoughtEvent {
  using Mask = typename P::Mask;
  Mask open;  ///< lanes that locate one
  Mask breaks_away, closes, creep_on, creep_off;

  ZEROCOUNT_ALWAYS_INLINE P choose(const P& if_breakaway, const P& if_closure, const P& if_creep_on,
                                   const P& if_creep_off) const {
    return select(breaks_away, if_breakaway,
                  select(closes, if_closure, select(creep_on, if_creep_on, if_creep_off)));
  }
};

/// Moves the end of the step back to the sought event.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void go_back_to(const BatchState& batch, const At& at, const SoughtEvent<P>& sought,
                                        StickStep<P>& step) {
  using Mask = typename P::Mask;
  const StickSeries<P>& s = step.series;
  const P zero(0.0);
  const P hook_sign = sign(hook_torque_at_end(step));
  const P start_sign = sign(step.torque);
  const P thresholds =
      sought.choose(step.breakaway_torque, at.load(batch.motion.branch_end) - step.elongation_start,
                    at.load(batch.motion.creep_onset), zero);
  P f[batch_order + 1];
  for (int k = 0; k <= batch_order; ++k) {
    const P elongation = k == 0 ? zero : elongation_coefficient(step, k);
    const P creep = k == batch_order ? zero : P(static_cast<double>(k + 1)) * s.scaled_creep[k + 1];
    f[k] = sought.choose(hook_sign * hook_coefficient(step, k), elongation,
                         start_sign * torque_coefficient(step, k), step.torque_sign * step.length * creep);
  }
  f[0] = f[0] - thresholds;
  // Creep ends before σ is zero, beyond which the series of its rate, in σ², would rise again.
  P last = step.x;
  const Mask crosses = sought.open & sought.creep_off & (step.torque_sign * step.torque <= zero);
  if (crosses.any()) {
    P torque_left[batch_order + 1];
    for (int k = 0; k <= batch_order; ++k) torque_left[k] = step.torque_sign * torque_coefficient(step, k);
    const P crossing = root_between(torque_left, batch_order, torque_left[0], step.torque_sign * step.torque,
                                    step.x, crosses);
    last = select(crosses, crossing, step.x);
  }
  const P f_end = value_of(f, batch_order, last);
  const Mask bracketed = f[0] * f_end < zero;
  const P found =
      select(bracketed, root_between(f, batch_order, f[0], f_end, last, sought.open & bracketed), last);
  step.beyond = step.beyond | (sought.open & ~bracketed & ~crosses & (f_end != zero));
  step.event =
      select(sought.open, sought.choose(P(breakaway), P(closure), P(creep_on), P(creep_off)), step.event);
  end_at(found, sought.open, step);
  evaluate_creep(step);
  P velocity[batch_order + 1];
  for (int k = 0; k <= batch_order; ++k) velocity[k] = velocity_coefficient(step, k);
  step.velocity = select(sought.open, value_of(velocity, batch_order, step.x), step.velocity);
}

/// Locates the first event of each lane, and ends its step there.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void find_first_event(const BatchState& batch, const At& at, StickStep<P>& step) {
  using Mask = typename P::Mask;
  step.meets = no_lanes<P>();
  step.beyond = abs(step.hook_torque) >= step.breakaway_torque;
  // Each round locates one event; the next finds whether another is earlier.
  for (int round = 0; round < 4; ++round) {
    const EventsPassed<P> passed = events_passed(batch, at, step);
    const P hook_torque = hook_torque_at_end(step);
    const Mask breaks_away = (abs(hook_torque) >= step.breakaway_torque) & (step.event != P(breakaway));
    const Mask closes = passed.closes & (step.event != P(closure));
    const Mask starts = passed.creep_on & (step.event != P(creep_on));
    const Mask ends = passed.creep_off & (step.event != P(creep_off));
    SoughtEvent<P> sought;
    sought.open = step.here & (breaks_away | closes | starts | ends) & ~step.too_long & ~step.beyond;
    if (!sought.open.any()) break;
    sought.breaks_away = breaks_away;
    sought.closes = ~breaks_away & closes;
    sought.creep_on = ~breaks_away & ~closes & starts;
    sought.creep_off = ~breaks_away & ~closes & ~starts;
    go_back_to(batch, at, sought, step);
  }
  // The hook's torque may have been larger within the step.
  const P hook_at_end = hook_torque_at_end(step);
  const P hook_max = max(abs(step.hook_torque), abs(hook_at_end));
  const Mask near = (step.event != P(breakaway)) & (hook_max > P(0.5) * step.breakaway_torque);
  if ((near & ~step.too_long).any()) {
    step.too_long = step.too_long | (near & may_slip_within(step, hook_max));
  }
  const Mask slips = step.event == P(breakaway);
  step.beyond = step.beyond | (slips & ~(step.velocity * hook_at_end > P(0.0)));
  step.beyond = step.beyond & ~step.too_long;
}

}  // namespace zerocount::batch
