#include "runners/study_run/cost.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

#include <oneapi/tbb/info.h>

#include "core/batch/batch.hpp"
#include "runners/study_run/study_runner.hpp"

namespace zerocount {
namespace {

/// The trial, cut where it has more than `most` samples: a long one costs per sample what its beginning does,
/// or less.
TrialParameters beginning_of(TrialParameters trial, std::int64_t most) {
  CommandParameters& command = trial.command;
  std::int64_t samples = 0;
  std::size_t moves = 0;
  while (moves < move_count(trial) && samples < most) samples += samples_of_move(trial, moves++);
  if (command.torque.levels.empty()) {
    command.targets.resize(moves);
  } else {
    command.torque.levels.resize(moves);
  }
  if (samples <= most) return trial;
  // The last of them goes beyond: all are shortened alike.
  const double proportion = static_cast<double>(most) / static_cast<double>(samples);
  command.hold *= proportion;
  command.torque.rate /= proportion;
  return trial;
}

}  // namespace

StudyCost measure_cost(const Study& study) {
  constexpr double patience = 0.3;              // s
  constexpr std::int64_t max_samples = 200000;  // of one trial
  constexpr std::int64_t stride = 7919;         // a prime, so that the sample wanders over points and trials
  constexpr double samples_at_once = 1e6;       // enough to fill the lanes, unless trials are long
  StudyCost cost;
  const double per_trial = samples_per_trial(study);
  cost.samples = per_trial * static_cast<double>(trial_count(study));
  cost.cores = oneapi::tbb::info::default_concurrency();
  const std::int64_t rows = trial_count(study);
  const std::int64_t most = std::min<std::int64_t>(rows, 4096);
  const auto at_once = static_cast<std::int64_t>(std::clamp(samples_at_once / per_trial, 1.0, 512.0));
  BatchEngine engine;
  const auto start = std::chrono::steady_clock::now();
  double elapsed = 0.0;
  double samples = 0.0;
  for (std::int64_t i = 0; i < most && elapsed < patience;) {
    std::vector<TrialParameters> trials;
    for (const std::int64_t end = std::min(most, i + at_once); i < end; ++i) {
      const std::int64_t row = i * stride % rows;
      trials.push_back(
          beginning_of(study_trial(study, row / study.trials, row % study.trials).parameters, max_samples));
      samples += static_cast<double>(samples_of_trial(trials.back()));
    }
    std::vector<const TrialParameters*> places;
    places.reserve(trials.size());
    for (const TrialParameters& trial : trials) places.push_back(&trial);
    std::vector<TrialOutcome> outcomes(trials.size());
    engine.run(places, outcomes);
    elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  cost.seconds_per_sample = elapsed / samples;
  return cost;
}

}  // namespace zerocount
