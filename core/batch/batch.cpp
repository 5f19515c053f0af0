#include "core/batch/batch.hpp"

#include <algorithm>
#include <numeric>

#include "core/batch/lanes/running_batch.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::batch {
namespace {

/// Runs all trials of the batch in the engine's lanes.
/// @throws trial::Interrupted if a stop is requested
void run_lanes(RunningBatch& run) {
  for (int lane = 0; lane < run.used_lanes; ++lane) start_next_trial(run, lane);
  while (!run.lanes.active.empty()) {
    if (run.observers->stop.stop_requested()) throw trial::Interrupted{};
    ++run.rounds;
    close_gaps(run);
    change_torques(run);
    take_samples(run, end_moves(run));
    move_sticking(run);
    move_sliding(run);
    move_standing(run);
    move_bristles(run);
    move_free(run);
  }
}

}  // namespace

RunningBatch::RunningBatch(const BatchSettings& settings)
    : kernels(kernels_of(settings.instructions)),
      trials(static_cast<std::size_t>(std::clamp(settings.lanes, 1, max_lanes))) {
  // Any finite state will do for the spare lane: a trial with default parameters.
  trial::TrialParameters parameters;
  parameters.command.targets = {0};
  LaneTrial spare;
  spare.parameters = &parameters;
  start_trial(state, spare_lane, spare);
  state.time.time_to_stop[spare_lane] = state.time.sample_time[spare_lane];
}

BatchEngine::BatchEngine(const BatchSettings& settings)
    : running_(std::make_unique<RunningBatch>(settings)) {}
BatchEngine::~BatchEngine() = default;

std::int64_t BatchEngine::rounds() const {
  return running_->rounds;
}

void BatchEngine::run(const TrialSource& source, std::span<trial::TrialOutcome> outcomes,
                      const BatchObservers& observers) {
  RunningBatch& run = *running_;
  run.source = &source;
  run.outcomes = outcomes;
  run.observers = &observers;
  run.next_trial = 0;
  run.rounds = 0;
  run.used_lanes = static_cast<int>(run.trials.size());
  run.state.passed = observers.sample ? run.passed_samples : nullptr;
  // Equal trials in equal lanes then need no new memory in the next run.
  std::iota(run.trial_index, run.trial_index + run.used_lanes, std::size_t{0});

  for (trial::TrialOutcome& outcome : outcomes) outcome.moves.clear();

  try {
    run_lanes(run);
  } catch (const trial::Interrupted&) {
    for_each_lane(run.lanes.active, [&](int lane) { run.trial_of(lane).outcome->moves.clear(); });
    throw;
  }
}

void BatchEngine::run(std::span<const trial::TrialParameters* const> trials,
                      std::span<trial::TrialOutcome> outcomes, const BatchObservers& observers) {
  const auto source = [trials](std::size_t trial, std::size_t) -> const trial::TrialParameters& {
    return *trials[trial];
  };
  run(source, outcomes.first(trials.size()), observers);
}

}  // namespace zerocount::batch
