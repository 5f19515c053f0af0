#include "runners/study_run/cost.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

#include <oneapi/tbb/info.h>

#include "core/batch/batch.hpp"
#include "runners/study_run/study_runner.hpp"

namespace zerocount::study_run {
namespace {

/// The trial, shortened to `max_samples`: the cost per sample of a long trial is at most that of its
/// beginning.
trial::TrialParameters beginning_of(trial::TrialParameters trial, std::int64_t max_samples) {
  trial::CommandParameters& command = trial.command;
  std::int64_t samples = 0;
  std::size_t moves = 0;
  while (moves < trial::move_count(trial) && samples < max_samples)
    samples += trial::samples_of_move(trial, moves++);
  if (command.torque.levels.empty()) {
    command.targets.resize(moves);
  } else {
    command.torque.levels.resize(moves);
  }
  if (samples <= max_samples) return trial;
  // The last move exceeds the limit: shortens all moves by the same factor.
  const double proportion = static_cast<double>(max_samples) / static_cast<double>(samples);
  command.hold *= proportion;
  command.torque.rate /= proportion;
  return trial;
}

}  // namespace

StudyCost measure_cost(const study::Study& study) {
  constexpr double patience = 0.3;              // s
  constexpr std::int64_t max_samples = 200000;  // of one trial
  constexpr std::int64_t stride = 7919;    // a prime, so that the sample is spread over points and trials
  constexpr double samples_at_once = 1e6;  // enough to fill the lanes, unless trials are long
  StudyCost cost;
  const double per_trial = samples_per_trial(study);
  cost.samples = per_trial * static_cast<double>(study::trial_count(study));
  cost.cores = oneapi::tbb::info::default_concurrency();
  const std::int64_t rows = study::trial_count(study);
  const std::int64_t max_trials = std::min<std::int64_t>(rows, 4096);
  const auto at_once = static_cast<std::int64_t>(std::clamp(samples_at_once / per_trial, 1.0, 512.0));
  batch::BatchEngine engine;
  const auto start = std::chrono::steady_clock::now();
  double elapsed = 0.0;
  double samples = 0.0;
  for (std::int64_t i = 0; i < max_trials && elapsed < patience;) {
    std::vector<trial::TrialParameters> trials;
    for (const std::int64_t end = std::min(max_trials, i + at_once); i < end; ++i) {
      const std::int64_t row = i * stride % rows;
      trials.push_back(beginning_of(
          study::study_trial(study, row / study.trials, row % study.trials).parameters, max_samples));
      samples += static_cast<double>(trial::samples_of_trial(trials.back()));
    }
    std::vector<const trial::TrialParameters*> places;
    places.reserve(trials.size());
    for (const trial::TrialParameters& trial : trials) places.push_back(&trial);
    std::vector<trial::TrialOutcome> outcomes(trials.size());
    engine.run(places, outcomes);
    elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  cost.seconds_per_sample = elapsed / samples;
  return cost;
}

}  // namespace zerocount::study_run
