#include <algorithm>
#include <chrono>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/trials/study_runner.hpp"

namespace zerocount::forecast {
namespace {

/// Shortens a trial to at most `max_samples` samples, so that its cost can be measured quickly. The cost per
/// sample of a long trial is at most that of its beginning.
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

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

trial::TrialParameters parameters_of(const study::Study& study, std::int64_t row) {
  return study::study_trial(study, row / study.trials, row % study.trials).parameters;
}

constexpr double patience = 0.05;  // s

/// Number of trials that are measured together, and number of samples at which each is cut.
struct BlockSize {
  std::int64_t trials;
  std::int64_t samples_of_trial;
};

/// Size of a block of trials that takes not much longer than `patience`, judged by the cost of the beginning
/// of some trials. It has at most a million samples, which fill the SIMD lanes unless trials are long.
BlockSize affordable_block(const study::Study& study, double samples_of_trial) {
  constexpr std::int64_t tried = 4;
  constexpr std::int64_t short_trial = 100;  // samples
  constexpr double speed_of_lanes = 10.0;    // in proportion to trials that are run alone
  const std::int64_t rows = study::trial_count(study);
  double slowest = 0.0;
  for (std::int64_t i = 0; i < std::min(tried, rows) && slowest < patience; ++i) {
    const trial::TrialParameters trial = beginning_of(parameters_of(study, i * rows / tried), short_trial);
    const Clock::time_point start = Clock::now();
    trial::run_trial(trial);
    slowest = std::max(slowest, seconds_since(start));
  }
  const double speed = std::min(speed_of_lanes, static_cast<double>(rows));
  const double affordable = speed * patience * static_cast<double>(short_trial) / slowest;
  const double samples = std::clamp(affordable, static_cast<double>(short_trial), 1e6);
  return {static_cast<std::int64_t>(std::clamp(samples / samples_of_trial, 1.0, 512.0)),
          static_cast<std::int64_t>(std::min(samples, 2e5))};
}

}  // namespace

StudyCost measure_cost(const study::Study& study) {
  constexpr std::int64_t stride = 7919;  // a prime, so that the sample is spread over points and trials
  StudyCost cost;
  const double per_trial = trials::samples_per_trial(study);
  cost.samples = per_trial * static_cast<double>(study::trial_count(study));
  cost.cores = trials::threads_to_use(0);
  const std::int64_t rows = study::trial_count(study);
  const std::int64_t max_trials = std::min<std::int64_t>(rows, 4096);
  const BlockSize size = affordable_block(study, per_trial);
  batch::BatchEngine engine;
  const auto start = std::chrono::steady_clock::now();
  double elapsed = 0.0;
  double samples = 0.0;
  for (std::int64_t i = 0; i < max_trials && elapsed < patience;) {
    std::vector<trial::TrialParameters> trials;
    for (const std::int64_t end = std::min(max_trials, i + size.trials); i < end; ++i) {
      const std::int64_t row = i * stride % rows;
      trials.push_back(beginning_of(parameters_of(study, row), size.samples_of_trial));
      samples += static_cast<double>(trial::samples_of_trial(trials.back()));
    }
    std::vector<const trial::TrialParameters*> places;
    places.reserve(trials.size());
    for (const trial::TrialParameters& trial : trials) places.push_back(&trial);
    std::vector<trial::TrialOutcome> outcomes(trials.size());
    engine.run(places, outcomes);
    elapsed = seconds_since(start);
  }
  cost.seconds_per_sample = elapsed / samples;
  return cost;
}

PointsOnReference points_on_reference(const study::Study& study) {
  constexpr std::int64_t max_points = 1000;
  PointsOnReference use;
  if (study.engine == study::Engine::reference) return use;  // as asked for
  const study::TrialIndices indices = study::trial_indices(study);
  use.examined = std::min(study::point_count(study), max_points);
  for (std::int64_t point = 0; point < use.examined; ++point) {
    bool lacking = false;
    for (std::int64_t setting = 0; setting < indices.settings.total(); ++setting) {
      for (const std::string& feature : batch::lacking_in_lanes(
               study::study_trial(study, point, indices.trial_of(0, setting)).parameters)) {
        lacking = true;
        if (std::find(use.features.begin(), use.features.end(), feature) == use.features.end())
          use.features.push_back(feature);
      }
    }
    use.points += lacking;
  }
  return use;
}

std::string engine_text(const PointsOnReference& use) {
  if (use.points == 0) return "";
  const std::string points =
      use.points == use.examined ? "all trials" : fmt::format("{} of {} points", use.points, use.examined);
  return fmt::format("{} run on the reference engine, several times slower, because of {}", points,
                     fmt::join(use.features, ", "));
}

}  // namespace zerocount::forecast
