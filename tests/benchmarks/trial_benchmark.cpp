// What a trial-sample costs: the trial itself, its peer with Boost.odeint, and what a run adds around it.
//
// The figure is the counter per_sample: time of one core per sample of a trial. Compare rows of one
// run only.
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/trial/trial.hpp"
#include "experiments/study.hpp"
#include "results/shards/shard.hpp"
#include "runners/study_runner.hpp"
#include "tests/support/odeint_trial.hpp"

namespace zerocount {
namespace {

Study shipped_study(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return load_study(std::filesystem::path(ZEROCOUNT_MANIFESTS) / (name + ".yaml"), overrides);
}

/// The n-th trial of the study, wandering over its points.
StudyTrial nth_trial(const Study& study, std::int64_t n) {
  const std::int64_t row = n * 7919 % trial_count(study);
  return study_trial(study, row / study.trials, row % study.trials);
}

void count_samples(benchmark::State& state, double samples) {
  state.counters["per_sample"] =
      benchmark::Counter(samples, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

double samples_of(const TrialParameters& parameters) {
  return static_cast<double>(samples_of_trial(parameters));
}

/// Trials of a shipped study, one after the other, by `simulate`.
template <class Simulate>
void simulate_trials(benchmark::State& state, const std::string& name, Simulate simulate) {
  const Study study = shipped_study(name);
  double samples = 0.0;
  std::int64_t n = 0;
  for (auto _ : state) {
    const StudyTrial next = nth_trial(study, n++);
    benchmark::DoNotOptimize(simulate(next.parameters));
    samples += samples_of(next.parameters);
  }
  count_samples(state, samples);
}

void trial(benchmark::State& state, const std::string& name) {
  simulate_trials(state, name, [](const TrialParameters& parameters) { return run_trial(parameters); });
}

void odeint(benchmark::State& state, const std::string& name) {
  simulate_trials(state, name, [](const TrialParameters& p) { return testing::odeint_trial(p); });
}

/// Drawing the parameters of a trial.
void draw(benchmark::State& state, const std::string& name) {
  const Study study = shipped_study(name);
  const double samples = samples_per_trial(study);
  std::int64_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(nth_trial(study, n++));
  count_samples(state, samples * static_cast<double>(n));
}

/// A run of all design points on one thread but for its last step, joining the shards: drawing, the trials
/// with their measures, writing.
void run(benchmark::State& state, const std::string& name) {
  const Study study = shipped_study(name, {"trials=200"});
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "zerocount-benchmark";
  const std::int64_t trials = trial_count(study);
  double samples = 0.0;
  for (auto _ : state) {
    std::filesystem::create_directories(folder);
    const std::vector<RowRange> rows{{0, trials}};
    run_trials(study, rows, folder, {1, {}}, {});
    samples += samples_per_trial(study) * static_cast<double>(trials);
    std::filesystem::remove_all(folder);
  }
  count_samples(state, samples);
}

/// The same trials as `run`, without anything around them.
void run_bare(benchmark::State& state, const std::string& name) {
  const Study study = shipped_study(name, {"trials=200"});
  const std::int64_t trials = trial_count(study);
  std::vector<TrialParameters> parameters;
  for (std::int64_t row = 0; row < trials; ++row) {
    parameters.push_back(study_trial(study, row / study.trials, row % study.trials).parameters);
  }
  double samples = 0.0;
  for (auto _ : state) {
    for (const TrialParameters& next : parameters) benchmark::DoNotOptimize(run_trial(next));
    samples += samples_per_trial(study) * static_cast<double>(trials);
  }
  count_samples(state, samples);
}

BENCHMARK_CAPTURE(trial, paper_fig7, std::string("paper-fig7"));
BENCHMARK_CAPTURE(odeint, paper_fig7, std::string("paper-fig7"));
BENCHMARK_CAPTURE(trial, paper_fig8, std::string("paper-fig8"));
BENCHMARK_CAPTURE(trial, paper_gains, std::string("paper-gains"));
BENCHMARK_CAPTURE(odeint, paper_gains, std::string("paper-gains"));
BENCHMARK_CAPTURE(draw, paper_gains, std::string("paper-gains"));
BENCHMARK_CAPTURE(run_bare, paper_gains, std::string("paper-gains"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, paper_gains, std::string("paper-gains"))->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace zerocount

BENCHMARK_MAIN();
