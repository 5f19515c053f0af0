// End of the moves and trials of lanes.
#include <utility>

#include "core/batch/lanes/running_batch.hpp"
#include "core/trial/divergence.hpp"
#include "core/trial/move_measures.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::batch {
namespace {

/// Measures of the move of one lane, copied from the batch state.
trial::RunningMeasures<double> measures_of(const MeasureLanes& lanes, int lane) {
  trial::RunningMeasures<double> measures;
  trial::for_each_measure([lane](double& to, const Lanes& from) { to = from[lane]; }, measures, lanes);
  return measures;
}

/// Measures of the error bands of one lane, copied from the batch state.
std::array<trial::BandMeasures<double>, trial::max_error_bands> bands_of(const MeasureLanes& lanes,
                                                                         int lane) {
  std::array<trial::BandMeasures<double>, trial::max_error_bands> bands;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const BandLanes& band = lanes.bands[b];
    bands[b] = {band.last_outside[lane], band.entry[lane], band.exits[lane]};
  }
  return bands;
}

/// Computes the outcome of the lane's move, which ends now.
/// @param stopped whether the move has diverged.
trial::MoveOutcome outcome_of(const BatchState& batch, int lane, LaneTrial& trial, bool stopped) {
  const trial::TrialParameters& p = *trial.parameters;
  const MeasureLanes& q = batch.measures;
  const LoopLanes& l = batch.loop;
  trial::MoveEnd end;
  end.last = {trial::target_of_move(p, trial.move),
              static_cast<std::int64_t>(l.count[lane]),
              l.decided[lane],
              false,
              q.theta[lane],
              q.extension[lane]};
  end.broke_away = trial.slid_at_start || trial.breakaways > 0 || q.slid[lane] != 0.0;
  end.reversal_depth = trial.deepest;
  end.stopped = stopped;
  const trial::MoveTiming timing = trial::move_timing(p, trial.move);
  trial::RunningMeasures<double> measures = measures_of(q, lane);
  if (timing.judged) {
    trial.last_half.finish(end.last.count);
  } else {
    measures.overshoot = 0.0;  // without a target
  }
  trial::MoveOutcome outcome =
      trial::outcome_of_move(timing, measures, bands_of(q, lane), trial.jerks, trial.last_half, end);
  if (timing.judged) {
    const std::int64_t reference = end.last.target + (trial.loop ? trial.loop->reference_offset() : 0);
    outcome.true_error =
        trial::true_error(reference, q.theta[lane] - trial.read_twist, l.resolution[lane], l.phase[lane]);
  }
  if (needs_lane_noise(p))
    outcome.encoder_disagreement = static_cast<std::int64_t>(batch.noise.disagreements[lane]);
  if (trial.loop) trial.loop->finish(outcome);
  if (trial.position) trial.position->finish(outcome);
  return outcome;
}

void record_move(RunningBatch& run, int lane, LaneTrial& trial, bool stopped) {
  if (run.lanes.ahead.contains(lane)) bring_up_to_date(run.state, lane, trial);
  run.lanes.ahead.erase(lane);
  if (trial.jerks.end(run.samples_of(lane))) report_jerk(run, trial);
  trial.outcome->moves.push_back(outcome_of(run.state, lane, trial, stopped));
}

void end_move(RunningBatch& run, int lane) {
  LaneTrial& trial = run.trial_of(lane);
  record_move(run, lane, trial, false);
  if (++trial.move == trial::move_count(*trial.parameters)) return start_next_trial(run, lane);
  trial.first_sample += run.samples_of(lane);
  start_move(run.state, lane, trial);
}

template <class Numbers>
void copy_lane(Numbers& numbers, int from, int to) {
  for_each_quantity(numbers, [&](Lanes& quantity) { quantity[to] = quantity[from]; });
}

void move_lane(RunningBatch& run, int from, int to) {
  copy_lane(static_cast<LaneNumbers&>(run.state), from, to);
  copy_lane(run.state.ahead, from, to);
  if (run.lanes.noisy.contains(from)) copy_lane(run.state.noise, from, to);
  if (run.lanes.with_blocks.contains(from)) copy_lane(run.state.blocks, from, to);
  if (run.lanes.amplified.contains(from)) copy_lane(run.state.drive, from, to);
  if (run.trial_of(from).drive) copy_lane(run.state.course, from, to);
  if (run.lanes.loaded.contains(from)) copy_lane(run.state.load, from, to);
  if (run.lanes.elements.contains(from)) copy_lane(run.state.elements, from, to);
  std::swap(run.trial_index[to], run.trial_index[from]);
  for (LaneSet* of : run.lanes.all()) {
    if (of->contains(from)) of->insert(to);
    of->erase(from);
  }
}

}  // namespace

LaneSet end_moves(RunningBatch& run) {
  LaneSet at_stop = run.kernels.lanes_at_stop(run.state);
  bool ended = false;
  for_each_lane(at_stop.in_both(run.lanes.active), [&](int lane) {
    if (run.state.measures.samples[lane] != run.state.measures.limits.samples[lane]) return;
    end_move(run, lane);
    ended = true;
  });
  if (ended) at_stop = run.kernels.lanes_at_stop(run.state);  // the first sample of a trial may be late
  return at_stop.in_both(run.lanes.active);
}

void stop_diverged(RunningBatch& run, int lane) {
  LaneTrial& trial = run.trial_of(lane);
  record_move(run, lane, trial, true);
  std::vector<trial::MoveOutcome>& moves = trial.outcome->moves;
  while (moves.size() < trial.parameters->command.targets.size())
    moves.push_back(trial::move_not_run(moves.size()));
  start_next_trial(run, lane);
}

void run_scalar(RunningBatch& run, const LaneTrial& trial, std::int64_t reported_jerks,
                std::int64_t reported_samples) {
  const BatchObservers& observers = *run.observers;
  trial::TrialObservers single;
  single.stop = observers.stop;
  std::int64_t jerks = 0;
  if (observers.jerk) {
    single.jerk = [&](const trial::Jerk& jerk) {
      if (jerks++ >= reported_jerks) observers.jerk(trial.number, jerk);
    };
  }
  if (observers.sample) {
    single.sample = [&](const trial::SampleRecord& r) {
      if (r.k >= reported_samples)
        observers.sample({trial.number, r.k, r.count, r.code, r.theta, r.xp, r.xh});
    };
  }
  *trial.outcome = trial::run_trial(*trial.parameters, single);
}

void fall_back_to_scalar(RunningBatch& run, int lane) {
  const LaneTrial& trial = run.trial_of(lane);
  run_scalar(run, trial, trial.reported_jerks, trial.first_sample + run.samples_of(lane));
  start_next_trial(run, lane);
}

void close_gaps(RunningBatch& run) {
  const int running = run.lanes.active.count();
  if (running == run.used_lanes || run.next_trial < run.outcomes.size()) return;
  int gap = 0;
  for (; run.used_lanes > running; --run.used_lanes) {
    const int last = run.used_lanes - 1;
    if (!run.lanes.active.contains(last)) continue;
    while (run.lanes.active.contains(gap)) ++gap;
    move_lane(run, last, gap);
  }
}

}  // namespace zerocount::batch
