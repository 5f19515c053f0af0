#pragma once

#include "core/batch/lane_group.hpp"
#include "core/batch/stick_series.hpp"

namespace zerocount::batch {

/// Whether the hook's torque may reach `breakaway` (N m) between the ends of a step, of which the larger
/// torque is `at_ends` (N m). @param per_step c/h, N m s/rad.
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Truth may_slip_within(const StickSeries<P>& s, const P& per_step,
                                                          const P& at_ends, const P& breakaway) {
  P hook[batch_order + 1];
  for (int k = 0; k <= batch_order; ++k) hook[k] = s.torque[k] + per_step * s.velocity[k];
  const P bend = curvature_bound(hook, batch_order);
  return (at_ends + bend * P(0.125) >= breakaway) & ~(magnitude(hook[1]) > bend);
}

/// One step of each lane whose hook sticks and that stick_start_kernel and its notes have prepared: to the
/// next stop, to the first event, or as far as the series carry. Notes what happened at its end; nothing of a
/// lane changes but its next step where the step was too long. A step with events other than a reversal is
/// not made but noted as meets_event, unless `Events`.
template <class P, bool Events>
void stick_step_kernel(Tile& tile, LaneList list) {
  using Truth = typename P::Truth;
  MotionLanes& m = tile.motion;
  ContactLanes& c = tile.contact;
  TimeLanes& time = tile.time;
  MeasureLanes& q = tile.measures;
  LoopLanes& l = tile.loop;
  tile.noted_count = 0;
  tile.passed_count = 0;
  const P zero(0.0);
  const P one(1.0);
  for (int first = 0, next = 0; first < list.count; first = next) {
    const LaneGroup<P> at(list, first);
    next = first + at.used();
    const P until = at.load(time.until);
    const Truth turning = truth(at.load(m.turning));
    // Half a period of the stiffest spring lies between two zeros of dxs/dt. Of these there must be one at
    // most.
    const P longest = at.load(time.longest_step) * select(turning, P(4.5), P(3.0));
    P h = smaller(smaller(at.load(time.next_step), until), longest);
    h = select((h < until) & (until < P(1.4) * h), until * P(0.5), h);

    const P per_inertia = at.load(c.per_inertia);
    const P damping = at.load(c.damping);
    const P alpha = at.load(c.alpha);
    const P per_lambda = at.load(c.per_lambda);
    const P breakaway = at.load(c.breakaway);
    const P branch_sign = at.load(m.branch_sign);
    const P softening_rate = at.load(m.branch_softening_rate);
    const P softness = at.load(m.softness);
    const P torque_at_start = at.load(m.spring_torque);
    const P torque_sign = select(torque_at_start < zero, P(-1.0), one);
    const Truth creeping = truth(at.load(m.creeping));
    const P extension = at.load(m.extension);
    const P hardening = at.load(m.hardening);
    const P elongation = at.load(m.elongation);

    StickLaw<P> law;
    law.acceleration = h * h * per_inertia;
    law.damping = damping * h * per_inertia;
    law.applied = at.load(m.torque);
    law.k1 = at.load(c.k1);
    law.softening = branch_sign * at.load(m.branch_softening_torque);
    law.exponent = -branch_sign * softening_rate;
    law.creep_recovery = select(creeping, alpha * h, zero);
    law.creep_limit = torque_sign * law.creep_recovery * per_lambda;
    StickSeries<P> s;
    s.elongation[0] = elongation;
    s.velocity[0] = at.load(m.omega) * h;
    s.growth[0] = torque_sign * hardening;
    s.torque[0] = torque_at_start;
    expand(law, softness, turning, (creeping & at.taking_part()).any(), s);

    // Where dxs/dt is zero at the start, its next zero is that of (dxs/dt)/t.
    const P rate_end = sum_of(s.rate, batch_order - 1);
    const P rate_start = select(turning, s.rate[1], s.rate[0]);
    const Truth reverses = rate_start * rate_end < zero;
    const P direction = at.load(m.direction);

    // Is the step short enough? A swing of less than 5e-6 count is followed to 2e-6 of its amplitude.
    const P last_terms = (magnitude(s.elongation[batch_order - 1]) + magnitude(s.velocity[batch_order - 1])) +
                         (magnitude(s.elongation[batch_order]) + magnitude(s.velocity[batch_order]));
    const P swings = at.load(time.longest_step) / h;
    const P amplitude = larger(magnitude(s.rate[0]), magnitude(s.rate[1]) * swings) * swings;
    const P scale = smaller(larger(amplitude * at.load(time.per_count) * P(2e5), P(1e-3)), one);
    const P allowed = at.load(time.tolerance) * scale * (h * at.load(time.sample_rate));
    Truth too_long = P(1.0) < P(0.0);
    // Inwards along a virgin curve the exponential grows, and must not by many e-folds.
    const Truth inwards = direction * branch_sign < zero;
    if ((inwards & at.taking_part()).any()) {
      const P growth = softening_rate * reach_bound(s.elongation, batch_order);
      const P exponent = softening_rate * branch_sign * (elongation - at.load(m.branch_elongation));
      too_long = inwards & (growth > P(6.0)) & (exponent - growth < P(40.0));
    }
    // What creep adds to dxs/dt may bring it through zero and back where it is as small.
    const P creep_velocity = P(8.0) * alpha * damping / law.k1 * magnitude(s.creep[0]);
    const Truth unsure = at.taking_part() & ~reverses &
                         (smaller(magnitude(rate_start), magnitude(rate_end)) <= creep_velocity);
    const Truth here = at.taking_part();
    const Truth seeks = here & reverses & ~too_long;
    P x = one;
    // Up to a reversal the series need not reach farther.
    P left_out = last_terms;
    P share = allowed;
    if ((seeks | unsure).any()) {
      P g[batch_order];
      for (int k = 0; k < batch_order - 1; ++k) g[k] = select(turning, s.rate[k + 1], s.rate[k]);
      g[batch_order - 1] = select(turning, zero, s.rate[batch_order - 1]);
      if (unsure.any()) {
        const P curvature = curvature_bound(g, batch_order - 1);
        too_long = too_long | (unsure & ~cannot_turn(g[0], rate_end, g[1], curvature));
      }
      if (seeks.any()) {
        x = select(seeks, root_between(g, batch_order - 1, g[0], rate_end, one, seeks), one);
        left_out = last_terms;
#pragma GCC unroll 1
        for (int k = 1; k < batch_order; ++k) left_out = left_out * x;
        share = allowed * x;
      }
    }
    const Truth inexact = ~(left_out <= share);
    too_long = too_long | inexact;

    P torque;
    P end;
    P velocity;
    P signed_hardening;
    if (seeks.any()) {
      P value[4];
      values_of(s.torque, s.elongation, s.velocity, s.growth, batch_order, x, value);
      torque = value[0];
      end = value[1];
      velocity = value[2];
      signed_hardening = value[3];
    } else {
      torque = sum_of(s.torque, batch_order);
      end = sum_of(s.elongation, batch_order);
      velocity = sum_of(s.velocity, batch_order);
      signed_hardening = sum_of(s.growth, batch_order);
    }

    const P branch_end = at.load(m.branch_end);
    const P onset = at.load(m.creep_onset);
    const P per_step = damping / h;  // of ω·h, N m
    const P hook_at_start = torque_at_start + per_step * s.velocity[0];
    P event = noted<P>(reverses, reversal);
    Truth beyond = magnitude(hook_at_start) >= breakaway;
    Truth meets = P(1.0) < P(0.0);
    if constexpr (!Events) {
      const P creep_left =
          torque_sign * (law.creep_limit * torque * torque - law.creep_recovery * signed_hardening);
      const Truth closes = direction * (end - branch_end) >= zero;
      const Truth stops = creeping & (~(creep_left > zero) | (torque_sign * torque <= zero));
      const Truth starts = ~creeping & (magnitude(torque) >= onset);
      const P hook_larger = larger(magnitude(hook_at_start), magnitude(torque + per_step * velocity));
      Truth slips = hook_larger >= breakaway;
      const Truth near = ~too_long & (hook_larger > P(0.5) * breakaway);
      if ((near & here).any()) slips = slips | (near & may_slip_within(s, per_step, hook_larger, breakaway));
      meets = ~too_long & (closes | stops | starts | slips);
      beyond = P(1.0) < P(0.0);
    } else {
      // The first of them.
      for (int round = 0; round < 4; ++round) {
        const P hook_torque = torque + per_step * velocity;
        const P creep_left =
            torque_sign * (law.creep_limit * torque * torque - law.creep_recovery * signed_hardening);
        const Truth closes = direction * (end - branch_end) >= zero;
        const Truth stops = creeping & (~(creep_left > zero) | (torque_sign * torque <= zero));
        const Truth starts = ~creeping & (magnitude(torque) >= onset);
        const Truth loose = magnitude(hook_torque) >= breakaway;
        const Truth any = (closes & (event != P(closure))) | (stops & (event != P(creep_ends))) |
                          (starts & (event != P(creep_sets_in))) | (loose & (event != P(breaks_away)));
        const Truth open = here & any & ~too_long & ~beyond;
        if (!open.any()) break;
        // One at a time; the next round sees whether another is earlier still.
        const Truth is_loose = loose & (event != P(breaks_away));
        const Truth is_closure = ~is_loose & closes & (event != P(closure));
        const Truth is_start = ~is_loose & ~is_closure & starts & (event != P(creep_sets_in));
        const P hook_sign = sign(hook_torque);
        const P start_sign = sign(torque);
        P f[batch_order + 1];
        for (int k = 0; k <= batch_order; ++k) {
          const P of_hook = hook_sign * (s.torque[k] + per_step * s.velocity[k]);
          f[k] = select(is_loose, of_hook,
                        select(is_closure, s.elongation[k],
                               select(is_start, start_sign * s.torque[k], torque_sign * s.creep[k])));
        }
        f[0] =
            f[0] - select(is_loose, breakaway, select(is_closure, branch_end, select(is_start, onset, zero)));
        // Creep ends before σ is zero, beyond which the series of its rate, in σ², would rise again.
        P last = x;
        const Truth crosses = open & ~is_loose & ~is_closure & ~is_start & (torque_sign * torque <= zero);
        if (crosses.any()) {
          P torque_left[batch_order + 1];
          for (int k = 0; k <= batch_order; ++k) torque_left[k] = torque_sign * s.torque[k];
          last = select(
              crosses,
              root_between(torque_left, batch_order, torque_left[0], torque_sign * torque, x, crosses), x);
        }
        const P f_end = value_of(f, batch_order, last);
        const Truth bracketed = f[0] * f_end < zero;
        const P found =
            select(bracketed, root_between(f, batch_order, f[0], f_end, last, open & bracketed), last);
        beyond = beyond | (open & ~bracketed & ~crosses & (f_end != zero));
        x = select(open, found, x);
        event =
            select(open,
                   select(is_loose, P(breaks_away),
                          select(is_closure, P(closure), select(is_start, P(creep_sets_in), P(creep_ends)))),
                   event);
        torque = value_of(s.torque, batch_order, x);
        end = value_of(s.elongation, batch_order, x);
        velocity = value_of(s.velocity, batch_order, x);
        signed_hardening = value_of(s.growth, batch_order, x);
      }
      // Between the ends the hook's torque may have been larger.
      const P hook_at_end = torque + per_step * velocity;
      const P hook_larger = larger(magnitude(hook_at_start), magnitude(hook_at_end));
      const Truth near = (event != P(breaks_away)) & (hook_larger > P(0.5) * breakaway);
      if ((near & ~too_long).any()) {
        too_long = too_long | (near & may_slip_within(s, per_step, hook_larger, breakaway));
      }
      const Truth slips = event == P(breaks_away);
      beyond = beyond | (slips & ~(velocity * hook_at_end > zero));
      beyond = beyond & ~too_long;
    }

    // The samples on the way, at which nobody looked: their count is that of both ends.
    const P used = x * h;
    const P left = at.load(time.samples_left);
    const P sample_rate = at.load(time.sample_rate);
    const Truth stops_here = (event == zero) & ~(h < until);
    const P until_then = select(stops_here, zero, until - used);
    const P left_then = select(stops_here, one, larger(-floor_of(P(1e-9) - until_then * sample_rate), one));
    const P passed = left - left_then;
    const P extension_then = extension + (signed_hardening - s.growth[0]);
    const P hook = at.load(m.hook);
    const P per_count = at.load(time.per_count);
    const P phase = at.load(l.phase);
    const P count = at.load(l.count);
    const P lowest =
        (hook + smaller(elongation, end) + smaller(extension, extension_then)) * per_count + phase;
    const P highest =
        (hook + larger(elongation, end) + larger(extension, extension_then)) * per_count + phase;
    // Clear of the edges, where rounding has a say.
    const Truth same_count = (lowest - count > P(1e-9)) & (highest - count < P(1.0 - 1e-9));
    const Truth counts = (passed > zero) & ~same_count & ~too_long & ~beyond & ~meets;
    const Truth done = ~too_long & ~beyond & ~counts & ~meets;

    const P factor = P(0.9) * rough_power(allowed / last_terms, 1.0 / batch_order);
    const P shorter = select(inexact, h * smaller(larger(factor, P(0.05)), P(0.8)), h * P(0.5));
    // What speeds up will need shorter steps.
    const P slower = select(reverses, one, smaller(one, magnitude(end - elongation) / magnitude(rate_end)));
    // From one reversal to the next it takes about as long as from the one before.
    const P half_swing = select(turning & reverses & (P(4.0) * left_out <= share), P(1.25) * x * h, zero);
    const P longer = larger(h * smaller(larger(factor * slower, P(0.3)), P(2.5)), half_swing);
    at.store(time.next_step, select(too_long, shorter, select(done, longer, at.load(time.next_step))));
    const P sample_time = at.load(time.sample_time);
    at.store(time.until, select(done, until_then, select(counts, until - (left - one) * sample_time, until)));
    at.store(time.samples_left, select(done, left_then, select(counts, one, left)));
    at.store(time.steps, at.load(time.steps) + select(meets, zero, one));

    at.store(m.elongation, select(done, select(event == P(closure), branch_end, end), elongation));
    at.store(m.omega, select(done, velocity / h, at.load(m.omega)));
    at.store(m.extension, select(done, extension_then, extension));
    at.store(m.hardening, select(done, torque_sign * signed_hardening, hardening));
    at.store(m.turning, select(done, number<P>(event == P(reversal)), number<P>(turning)));
    at.store(m.spring_torque, select(done, torque, torque_at_start));

    const P taken = at.load(q.taken);
    const P zeros = at.load(q.zeros_in_a_row);
    const P passed_now = select(done, passed, zero);
    const Truth arrived = truth(at.load(q.arrived));
    const Truth arrives = ~arrived & (passed_now > zero) & (zeros + passed_now >= at.load(q.dwell));
    at.store(q.arrival, select(arrives, taken - zeros, at.load(q.arrival)));
    at.store(q.arrived, number<P>(arrived | arrives));
    at.store(q.zeros_in_a_row, zeros + passed_now);
    at.store(q.taken, taken + passed_now);

    at.note(tile, select(done, event, zero) + noted<P>(meets, meets_event) +
                      noted<P>(beyond | (at.load(time.steps) > P(most_steps_to_a_stop)), beyond_kernel));

    if (tile.passed != nullptr && ((passed_now > zero) & here).any()) {
      constexpr int width = sizeof(h.part[0]) / sizeof(double);
      for (int i = 0; i < P::lanes; ++i) {
        const int p = i / width;
        const int j = i % width;
        if (passed_now.part[p][j] == 0.0 || here.part[p][j] == 0) continue;
        PassedSamples& record = tile.passed[tile.passed_count++];
        record.lane = at.lane(i);
        record.samples = passed_now.part[p][j];
        record.until = until.part[p][j];
        record.step = h.part[p][j];
        record.end = x.part[p][j];
        for (int k = 0; k <= batch_order; ++k) {
          record.elongation[k] = s.elongation[k].part[p][j];
          record.growth[k] = s.growth[k].part[p][j];
        }
      }
    }
  }
}

}  // namespace zerocount::batch
