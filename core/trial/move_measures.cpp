#include "core/trial/move_measures.hpp"

#include <cstdlib>

namespace zerocount::trial {

std::span<const NamedMeasure> named_measures() {
  static constexpr NamedMeasure measures[]{{.name = "arrived"},
                                           {.name = "stable"},
                                           {.name = "broke_away"},
                                           {.name = "saturated"},
                                           {.name = "arrival"},
                                           {.name = "arrival_time"},
                                           {.name = "final_settling_time"},
                                           {.name = "zero_fraction"},
                                           {.name = "oscillation_amplitude"},
                                           {.name = "oscillation_period"},
                                           {.name = "overshoot"},
                                           {.name = "travel_time"},
                                           {.name = "midway_error"},
                                           {.name = "final_error"},
                                           {.name = "phase_changes"},
                                           {.name = "encoder_disagreement"},
                                           {.name = "true_error"},
                                           {.name = "final_position"},
                                           {.name = "holding_torque"},
                                           {.name = "peak_torque"},
                                           {.name = "creep"},
                                           {.name = "reversal_depth"},
                                           {.name = "jerk_count"},
                                           {.name = "jerk_agreement"},
                                           {.name = "true_overshoot", .of_position = true},
                                           {.name = "rest_error_rms", .of_motion = true},
                                           {.name = "rest_error_range", .of_motion = true},
                                           {.name = "rest_motion_rms", .of_motion = true},
                                           {.name = "rest_motion_range", .of_motion = true},
                                           {.name = "rest_torque_power", .of_motion = true},
                                           {.name = "rest_torque_noise", .of_motion = true},
                                           {.name = "following_error_rms", .of_motion = true},
                                           {.name = "following_error_peak", .of_motion = true},
                                           {.name = "reversal_spike", .of_motion = true},
                                           {.name = "step_motion", .of_motion = true},
                                           {.name = "step_made", .of_motion = true}};
  return measures;
}

std::string_view meanings_of_settling_time(std::string_view name) {
  constexpr std::string_view bare = "settling_time";
  if (!name.starts_with(bare)) return {};
  const std::string_view rest = name.substr(bare.size());
  if (!rest.empty() && rest.front() != '.' && rest.front() != '_') return {};
  return "arrival_time (the error is 0 for the first time, for the dwell) or final_settling_time (the error is 0 for good)";
}

std::span<const std::string_view> named_band_measures() {
  static constexpr std::string_view measures[]{"band_entry_time", "band_settling_time", "band_exits"};
  return measures;
}

namespace {

std::int64_t whole(double number) {
  return static_cast<std::int64_t>(number);
}

/// Outcome of a move with a target: zero_count or one_count if max |e| in the window at the end of the move
/// is 0 or 1; otherwise off_target if the count only approaches the target in the last half of the move, and
/// oscillating if not.
/// @param largest_error max |e| in the window, counts
/// @param target position of the target, counts
/// @param last_half counts in the last half of the move
Outcome verdict(double largest_error, std::int64_t target, const LastHalf& last_half) {
  if (largest_error == 0.0) return Outcome::zero_count;
  if (largest_error == 1.0) return Outcome::one_count;
  return last_half.only_approaches(target) ? Outcome::off_target : Outcome::oscillating;
}

/// Sets the verdict on a move with a target, and the measures that depend on the verdict.
void judge_end(const MoveTiming& timing, const RunningMeasures<double>& m, const LastHalf& last_half,
               const MoveEnd& end, MoveOutcome& outcome) {
  if (end.stopped) {
    outcome.outcome = Outcome::oscillating;
  } else if (end.finite) {
    const std::int64_t target = end.last.target;
    outcome.outcome = verdict(m.largest_in_window, target, last_half);
    outcome.midway_error = target - last_half.first();
    if (m.zeros_in_a_row > 0.0) {
      outcome.final_settling_time = (m.samples - m.zeros_in_a_row) * timing.sample_time;
    }
    if (outcome.outcome == Outcome::oscillating) {
      outcome.oscillation_amplitude = last_half.amplitude();
      outcome.oscillation_period = last_half.period(timing.sample_time);
    }
  }
}

/// The outcome for one error band of a move whose samples were all run.
/// @param samples number of samples of the move.
BandOutcome outcome_of_band(const MoveTiming& timing, double samples, BandMeasures<double> band) {
  // One more sample, outside, ends the last run inside the band.
  const double settled = band.last_outside + 1.0;
  const double exits = band.exits;
  measure_band(band, 0.0, static_cast<double>(timing.dwell), samples, 1.0);
  BandOutcome outcome{.exits = exits};
  if (band.entry >= 0.0) outcome.entry_time = band.entry * timing.sample_time;
  if (settled < samples) outcome.settling_time = settled * timing.sample_time;
  return outcome;
}

}  // namespace

MoveTiming move_timing(const TrialParameters& parameters, std::size_t move) {
  const double rate = parameters.controller.sample_rate;
  return {1.0 / rate,
          samples_of_move(parameters, move),
          samples_in(parameters.verdict.dwell, rate),
          samples_in(parameters.verdict.window, rate),
          parameters.command.torque.levels.empty(),
          parameters.verdict.bands,
          static_cast<std::int64_t>(move)};
}

MoveOutcome outcome_of_move(const MoveTiming& timing, const RunningMeasures<double>& m,
                            std::span<const BandMeasures<double>> bands, const Jerks& jerks,
                            const LastHalf& last_half, const MoveEnd& end) {
  MoveOutcome outcome;
  outcome.number = timing.number;
  outcome.stopped = end.stopped;
  outcome.broke_away = end.broke_away;
  outcome.saturated = m.saturated != 0.0;
  outcome.overshoot = whole(m.overshoot);
  outcome.final_error = end.last.target - end.last.count;
  outcome.final_position = end.last.theta;
  outcome.holding_torque = end.last.torque;
  outcome.peak_torque = m.peak_torque;
  outcome.creep = end.last.creep;
  outcome.reversal_depth = end.reversal_depth;
  outcome.jerk_count = jerks.count();
  if (outcome.jerk_count > 0) {
    const std::int64_t agreeing =
        outcome.holding_torque > 0.0 ? jerks.up() : (outcome.holding_torque < 0.0 ? jerks.down() : 0);
    outcome.jerk_agreement = static_cast<double>(agreeing) / static_cast<double>(outcome.jerk_count);
  }
  if (m.arrived != 0.0) {
    outcome.arrived = true;
    outcome.stable = end.finite && m.largest_since_arrival <= 1.0;
    outcome.arrival = whole(m.arrival);
    outcome.arrival_time = m.arrival * timing.sample_time;
    const double since_arrival = m.samples - m.arrival;
    outcome.zero_fraction = (since_arrival - static_cast<double>(jerks.samples())) / since_arrival;
  }
  if (timing.judged) {
    judge_end(timing, m, last_half, end, outcome);
    for (std::size_t b = 0; b < timing.bands.count && end.finite && !end.stopped; ++b)
      outcome.bands[b] = outcome_of_band(timing, m.samples, bands[b]);
  } else if (end.finite) {
    outcome.outcome = Outcome::open_loop;
  }
  return outcome;
}

bool MoveMeasures::add(const MoveSample& sample) {
  const bool jerk_ended = timing_.judged && judge(sample);
  measure_torque(running_, sample.torque, sample.clipped);
  last_ = sample;
  return jerk_ended;
}

/// Updates the measures that depend on the error of this sample.
/// @returns whether a jerk (excursion of the error after arrival) ended before it.
bool MoveMeasures::judge(const MoveSample& sample) {
  const std::int64_t error = sample.target - sample.count;
  const std::int64_t k = whole(running_.samples);
  const bool dwelt = running_.arrived != 0.0;  // the dwell ended before this sample
  const MeasureLimits<double> limits{static_cast<double>(timing_.samples), static_cast<double>(timing_.dwell),
                                     static_cast<double>(timing_.window)};
  measure_error(running_, limits, static_cast<double>(error));
  for (std::size_t b = 0; b < timing_.bands.count; ++b) {
    const auto limit = static_cast<double>(timing_.bands.limits[b]);
    measure_band(bands_[b], limit, limits.dwell, static_cast<double>(k),
                 static_cast<double>(std::abs(error)));
  }
  const std::int64_t half = first_of_last_half(timing_.samples);
  if (k >= half) last_half_.add(k, k == half ? sample.count : last_.count, sample.count);
  return dwelt && jerks_.add(k, error);
}

bool MoveMeasures::finish(bool broke_away, std::int64_t reversal_depth, bool finite) {
  const bool jerk_cut = jerks_.end(whole(running_.samples));
  if (timing_.judged) last_half_.finish(last_.count);
  outcome_ = outcome_of_move(timing_, running_, bands_, jerks_, last_half_,
                             {last_, broke_away, reversal_depth, stopped_, finite});
  return jerk_cut;
}

}  // namespace zerocount::trial
