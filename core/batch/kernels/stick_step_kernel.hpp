#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/stick_events.hpp"

namespace zerocount::batch {

/// Time and sampling instants of a step. The sampling instants within the step are passed over, so the
/// encoder's count must be the same at all of them.
template <class P>
struct StepTiming {
  using Mask = typename P::Mask;
  P samples_to_stop;       ///< Number of samples to the lane's next stop, counted at the start of the step
  P time_to_stop_then;     ///< Time from the end of the step to the lane's next stop, s
  P samples_to_stop_then;  ///< Number of samples to the lane's next stop, counted at the end of the step
  P passed;                ///< Number of samples within the step, which are passed over
  P elongation;            ///< Spring elongation xs at the end of the step, rad
  P extension;             ///< Plastic extension xp by creep at the end of the step, rad
  Mask count_may_change;   ///< The count may change within the step, so the step is not made.
};

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE StepTiming<P> timing_of(const BatchState& batch, const At& at,
                                                const StickStep<P>& step) {
  using Mask = typename P::Mask;
  const TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  StepTiming<P> t;
  const Mask stops_here = (step.event == zero) & ~(step.h < step.time_to_stop);
  t.samples_to_stop = at.load(time.samples_to_stop);
  t.time_to_stop_then = select(stops_here, zero, step.time_to_stop - step.x * step.h);
  // At most those at the start: after a late sample the next one may be farther away than T.
  const P ahead = max(-floor(P(1e-9) - t.time_to_stop_then * at.load(time.sample_rate)), one);
  t.samples_to_stop_then = select(stops_here, one, min(ahead, t.samples_to_stop));
  t.passed = t.samples_to_stop - t.samples_to_stop_then;
  const P extension = at.load(batch.motion.extension);
  t.extension = extension + step.creep_change;
  t.elongation = step.elongation_start + step.elongation_change;
  const P hook = at.load(batch.motion.hook);
  const P per_count = at.load(time.per_count);
  const P phase = at.load(batch.loop.phase);
  const P count = at.load(batch.loop.count);
  const P start = step.elongation_start;
  const P lowest = (hook + min(start, t.elongation) + min(extension, t.extension)) * per_count + phase;
  const P highest = (hook + max(start, t.elongation) + max(extension, t.extension)) * per_count + phase;
  // The margin covers rounding errors at the edges.
  const P margin(1e-9);
  const Mask quiet = (lowest - count > at.load(batch.loop.quiet_from) + margin) &
                     (highest - count < at.load(batch.loop.quiet_to) - margin);
  t.count_may_change = (t.passed > zero) & ~quiet & ~step.too_long & ~step.beyond & ~step.has_event;
  return t;
}

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void store_time(BatchState& batch, const At& at, const StickStep<P>& step,
                                        const StepTiming<P>& t, const typename P::Mask& done) {
  TimeLanes& time = batch.time;
  const P zero(0.0);
  const P one(1.0);
  const P h = step.h;
  const P factor = P(0.85) * rough_power(step.allowed, step.last_terms, 1.0 / batch_order);
  const P shorter = shorter_step(h, step.inexact, factor);
  // A motion that accelerates will need shorter steps. (A displacement lost in rounding gives no
  // information.)
  const P moved = abs(step.elongation_change);
  const P slower = select(step.reverses | (moved == zero), one,
                          min(one, rough_power(moved, abs(step.length * step.rate_end), 1.0)));
  // From one reversal to the next it takes about as long as from the one before.
  const P half_oscillation =
      select(step.at_reversal & step.reverses & (P(4.0) * step.truncation_error <= step.allowed_at_x),
             P(1.25) * step.x * h, zero);
  const P longer = max(h * min(max(factor * slower, P(0.3)), P(2.5)), half_oscillation);
  // A step cut short by a stop does not shorten the next one.
  const P before = at.load(time.next_step);
  const P kept = select(~(h < step.time_to_stop) & (factor > one), max(longer, before), longer);
  at.store(time.next_step, select(step.too_long, shorter, select(done, kept, before)));
  const P to_next_sample = step.time_to_stop - (t.samples_to_stop - one) * at.load(time.sample_time);
  at.store(time.time_to_stop,
           select(done, t.time_to_stop_then, select(t.count_may_change, to_next_sample, step.time_to_stop)));
  at.store(time.samples_to_stop,
           select(done, t.samples_to_stop_then, select(t.count_may_change, one, t.samples_to_stop)));
  const P tries = at.load(time.steps) + select(step.has_event, zero, one);
  at.store(time.steps, select(done & (t.passed > zero), zero, tries));
}

template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void store_motion_of(BatchState& batch, const At& at, const StickStep<P>& step,
                                             const StepTiming<P>& t, const typename P::Mask& done) {
  MotionLanes& m = batch.motion;
  const P end = select(step.event == P(closure), at.load(m.branch_end), t.elongation);
  at.store(m.elongation, select(done, end, step.elongation_start));
  at.store(m.omega, select(done, step.velocity * step.per_h, at.load(m.omega)));
  at.store(m.extension, select(done, t.extension, at.load(m.extension)));
  at.store(m.hardening,
           select(done, step.torque_sign * (step.creep_start + step.creep_change), at.load(m.hardening)));
  at.store(m.at_reversal,
           select(done, to_number<P>(step.event == P(reversal)), to_number<P>(step.at_reversal)));
  at.store(m.spring_torque, select(done, step.torque, at.load(m.spring_torque)));
}

/// Records the samples that the step passes over, for the observer of the batch (BatchState::passed).
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void record_passed(BatchState& batch, const At& at, const StickStep<P>& step,
                                           const P& passed) {
  constexpr int width = sizeof(passed.part[0]) / sizeof(double);
  for (unsigned lanes = ((passed > P(0.0)) & step.here).bits(); lanes != 0; lanes &= lanes - 1) {
    const int i = __builtin_ctz(lanes);
    const int p = i / width;
    const int j = i % width;
    PassedSamples& record = batch.passed[batch.passed_count++];
    record.lane = at.lane(i);
    record.samples = passed.part[p][j];
    record.time_to_stop = step.time_to_stop.part[p][j];
    record.step = step.h.part[p][j];
    record.end = step.x.part[p][j];
    record.elongation[0] = step.elongation_start.part[p][j];
    for (int k = 1; k <= batch_order; ++k) record.elongation[k] = elongation_coefficient(step, k).part[p][j];
    for (int k = 0; k <= batch_order; ++k) {
      record.creep[k] = (step.length * step.series.scaled_creep[k]).part[p][j];
    }
  }
}

/// Integrates one step of one vector of lanes whose hook sticks; see stick_step_kernel(). It is not inlined,
/// so that each kind of vector has one copy.
template <bool Events, class At, class F>
__attribute__((noinline)) void step_of(BatchState& batch, const At& at, F forcing) {
  using P = typename At::Vector;
  const P zero(0.0);
  StickStep<P> step;
  begin_step(batch, at, step);
  decltype(torque_with<P>(forcing)) applied;
  expand_step(batch, at, forcing, step, applied);
  find_reversal(batch, at, forcing, applied, step);
  evaluate_end(step);
  step.event = events_where<P>(step.reverses, reversal);
  if constexpr (Events) {
    find_first_event(batch, at, step);
  } else {
    mark_events(batch, at, step);
  }
  const StepTiming<P> timing = timing_of(batch, at, step);
  const typename P::Mask done = ~step.too_long & ~step.beyond & ~timing.count_may_change & ~step.has_event;
  const P passed = select(done, timing.passed, zero);
  store_time(batch, at, step, timing, done);
  store_motion_of(batch, at, step, timing, done);
  if constexpr (F::forced) store_load(batch, at, applied, step.x, step.h, done);
  measure_passed(batch, at, passed);
  const typename P::Mask lost = step.beyond | (at.load(batch.time.steps) > P(max_steps_to_stop));
  const P event = select(done & (step.event != P(reversal)), step.event, zero);
  add_events(batch, at,
             event + events_where<P>(step.has_event, meets_event) + events_where<P>(lost, beyond_kernel));
  if (batch.passed != nullptr) record_passed(batch, at, step, passed);
}

/// One integration step of each lane whose hook sticks, after stick_start_kernel() and the handling of its
/// events. The step ends at the lane's next stop (at which its torque may change), at the first event, or
/// where the Taylor series cease to be accurate. Where the step was too long, only TimeLanes::next_step
/// changes. Reports events other than a reversal. With `Events` the step ends at the first of them; without,
/// a step that contains one is not made but reported as meets_event.
template <class V, bool Events>
void stick_step_kernel(BatchState& batch, const LaneSet& lanes, Forcing forcing) {
  batch.event_count = 0;
  batch.passed_count = 0;
  if constexpr (Events) {
    for_each_group<V>(lanes, [&](const auto& at) { step_of<Events>(batch, at, forcing); });
  } else {
    for_each_vector<V>(lanes, forcing, [&](const auto& at, auto of) { step_of<Events>(batch, at, of); });
  }
}

}  // namespace zerocount::batch
