#pragma once

#include "core/batch/kernels/stick_step.hpp"

namespace zerocount::batch {

/// Elongation xs of the contact's spring at the end of the used step, rad.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P elongation_end(const StickStep<P>& step) {
  return step.elongation_start + step.elongation_change;
}

/// Masks of the lanes in which each event of the sticking contact occurs within the step, except reversals.
template <class P>
struct ContactEvents {
  using Mask = typename P::Mask;
  Mask breakaway;  ///< |σ + c·ω|, the torque on the hook, has reached the breakaway torque.
  Mask closure;    ///< The spring's hysteresis branch has ended and its minor loop closes.
  Mask creep_on;   ///< The absolute spring torque |σ| has passed the torque at which creep sets in.
  Mask creep_off;  ///< Creep ends: its hardening has reached its limit, or the spring torque σ is zero.

  ZEROCOUNT_ALWAYS_INLINE Mask any() const { return breakaway | closure | creep_on | creep_off; }
  /// Selects one of four values for each lane, by the first of these events that is set in the order of the
  /// parameters; the last value also where none is set.
  ZEROCOUNT_ALWAYS_INLINE P choose(const P& if_breakaway, const P& if_closure, const P& if_creep_on,
                                   const P& if_creep_off) const {
    return select(breakaway, if_breakaway,
                  select(closure, if_closure, select(creep_on, if_creep_on, if_creep_off)));
  }
};

/// Series coefficient k of the torque σ + c·ω on the hook, N m.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P hook_coefficient(const StickStep<P>& step, int k) {
  return torque_coefficient(step, k) + step.per_step * velocity_coefficient(step, k);
}

/// Torque σ + c·ω on the hook at the end of the step, N m.
template <class P>
ZEROCOUNT_ALWAYS_INLINE P hook_torque_at_end(const StickStep<P>& step) {
  return step.torque + step.per_step * step.velocity;
}

/// The events of the contact whose threshold is passed between start and end of a step.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE ContactEvents<P> events_passed(const BatchState& batch, const At& at,
                                                       const StickStep<P>& step) {
  const P zero(0.0);
  const P remaining_creep = step.torque_sign * step.creep_velocity;
  return {abs(hook_torque_at_end(step)) >= step.breakaway_torque,
          step.direction * (elongation_end(step) - at.load(batch.motion.branch_end)) >= zero,
          ~step.creeping & (abs(step.torque) >= at.load(batch.motion.creep_onset)),
          step.creeping & (~(remaining_creep > zero) | (step.torque_sign * step.torque <= zero))};
}

/// Whether the hook's torque may reach the breakaway torque within the step.
/// @param at_ends larger absolute value of the hook's torque at both ends of the step, N m.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask may_break_away_within(const StickStep<P>& step, const P& at_ends) {
  P hook[batch_order + 1];
  for (int k = 0; k <= batch_order; ++k) hook[k] = hook_coefficient(step, k);
  const P curvature = curvature_bound(hook, batch_order);
  return (at_ends + curvature * P(0.125) >= step.breakaway_torque) & ~(abs(hook[1]) > curvature);
}

/// Marks the lanes whose step contains an event other than a reversal (StickStep::has_event), without
/// locating it.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void mark_events(const BatchState& batch, const At& at, StickStep<P>& step) {
  using Mask = typename P::Mask;
  ContactEvents<P> events = events_passed(batch, at, step);
  const P hook_max = max(abs(step.hook_torque), abs(hook_torque_at_end(step)));
  events.breakaway = hook_max >= step.breakaway_torque;
  const Mask near = ~step.too_long & (hook_max > P(0.5) * step.breakaway_torque);
  if ((near & step.here).any()) {
    events.breakaway = events.breakaway | (near & may_break_away_within(step, hook_max));
  }
  step.has_event = ~step.too_long & events.any();
  step.beyond = no_lanes<P>();
}

/// Shortens the step of the lanes in `open` to the instant of the first of their `events`. Each of these
/// lanes must have an event.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void go_back_to(const BatchState& batch, const At& at, const ContactEvents<P>& events,
                                        const typename P::Mask& open, StickStep<P>& step) {
  using Mask = typename P::Mask;
  const StickSeries<P>& s = step.series;
  const P zero(0.0);
  const P hook_sign = sign(hook_torque_at_end(step));
  const P start_sign = sign(step.torque);
  const P thresholds =
      events.choose(step.breakaway_torque, at.load(batch.motion.branch_end) - step.elongation_start,
                    at.load(batch.motion.creep_onset), zero);
  P f[batch_order + 1];
  for (int k = 0; k <= batch_order; ++k) {
    const P elongation = k == 0 ? zero : elongation_coefficient(step, k);
    const P creep = k == batch_order ? zero : P(static_cast<double>(k + 1)) * s.scaled_creep[k + 1];
    f[k] = events.choose(hook_sign * hook_coefficient(step, k), elongation,
                         start_sign * torque_coefficient(step, k), step.torque_sign * step.length * creep);
  }
  f[0] = f[0] - thresholds;
  // Creep ends before σ is zero, beyond which the series of its rate, in σ², would rise again.
  P last = step.x;
  const Mask ends_creep = ~(events.breakaway | events.closure | events.creep_on);
  const Mask crosses = open & ends_creep & (step.torque_sign * step.torque <= zero);
  if (crosses.any()) {
    P remaining_torque[batch_order + 1];
    for (int k = 0; k <= batch_order; ++k)
      remaining_torque[k] = step.torque_sign * torque_coefficient(step, k);
    const P crossing = root_between(remaining_torque, batch_order, remaining_torque[0],
                                    step.torque_sign * step.torque, step.x, crosses);
    last = select(crosses, crossing, step.x);
  }
  const P f_end = value_of(f, batch_order, last);
  const Mask bracketed = f[0] * f_end < zero;
  const P found = select(bracketed, root_between(f, batch_order, f[0], f_end, last, open & bracketed), last);
  step.beyond = step.beyond | (open & ~bracketed & ~crosses & (f_end != zero));
  step.event = select(open, events.choose(P(breakaway), P(closure), P(creep_on), P(creep_off)), step.event);
  end_at(found, open, step);
  evaluate_creep(step);
  P velocity[batch_order + 1];
  for (int k = 0; k <= batch_order; ++k) velocity[k] = velocity_coefficient(step, k);
  step.velocity = select(open, value_of(velocity, batch_order, step.x), step.velocity);
}

/// Locates the first event of the contact in each lane's step, and ends the step there.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void find_first_event(const BatchState& batch, const At& at, StickStep<P>& step) {
  using Mask = typename P::Mask;
  step.has_event = no_lanes<P>();
  step.beyond = abs(step.hook_torque) >= step.breakaway_torque;
  // Each round locates one event; the next finds whether another is earlier.
  for (int round = 0; round < 4; ++round) {
    ContactEvents<P> events = events_passed(batch, at, step);
    events.breakaway = events.breakaway & (step.event != P(breakaway));
    events.closure = events.closure & (step.event != P(closure));
    events.creep_on = events.creep_on & (step.event != P(creep_on));
    events.creep_off = events.creep_off & (step.event != P(creep_off));
    const Mask open = step.here & events.any() & ~step.too_long & ~step.beyond;
    if (!open.any()) break;
    go_back_to(batch, at, events, open, step);
  }
  // The hook's torque may have been larger within the step.
  const P hook_at_end = hook_torque_at_end(step);
  const P hook_max = max(abs(step.hook_torque), abs(hook_at_end));
  const Mask near = (step.event != P(breakaway)) & (hook_max > P(0.5) * step.breakaway_torque);
  if ((near & ~step.too_long).any()) {
    step.too_long = step.too_long | (near & may_break_away_within(step, hook_max));
  }
  const Mask breaks_away = step.event == P(breakaway);
  step.beyond = step.beyond | (breaks_away & ~(step.velocity * hook_at_end > P(0.0)));
  step.beyond = step.beyond & ~step.too_long;
}

}  // namespace zerocount::batch
