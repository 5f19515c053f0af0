#include "runners/cost.hpp"

#include <algorithm>
#include <chrono>

#include <oneapi/tbb/info.h>

#include "core/trial/trial.hpp"
#include "runners/study_runner.hpp"

namespace zerocount {

StudyCost measure_cost(const Study& study) {
  constexpr double patience = 0.3;       // s
  constexpr std::int64_t stride = 7919;  // a prime, so that the sample wanders over points and trials
  StudyCost cost;
  cost.samples = samples_per_trial(study) * static_cast<double>(trial_count(study));
  cost.cores = oneapi::tbb::info::default_concurrency();
  const auto start = std::chrono::steady_clock::now();
  double elapsed = 0.0;
  double samples = 0.0;
  const std::int64_t rows = trial_count(study);
  for (std::int64_t i = 0; i < std::min<std::int64_t>(rows, 1000) && elapsed < patience; ++i) {
    const std::int64_t row = i * stride % rows;
    const StudyTrial trial = study_trial(study, row / study.trials, row % study.trials);
    run_trial(trial.parameters);
    samples += static_cast<double>(samples_of_trial(trial.parameters));
    elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  cost.seconds_per_sample = elapsed / samples;
  return cost;
}

}  // namespace zerocount
