#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "runners/study_run/study_runner.hpp"
#include "tests/benchmarks/registration.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t trials_per_run = 4000;        // of bench-transient, unless the number is what varies
constexpr std::int64_t trials_for_threads = 200000;  // whose last lanes, each alone, are a small part
constexpr std::int64_t samples_per_run = 1200000;    // the same in samples, where the trial's length varies

/// What is not random takes these values.
constexpr std::array fixed_values{"friction.k1=110",    "friction.k2=750",    "friction.beta=2.0e5",
                                  "friction.alpha=0.5", "friction.lambda=10", "initial.encoder_phase=0.5",
                                  "command.targets.0=5"};

/// A run but for its last step, joining the shards: drawing, the trials with their measures, writing.
void time_run(benchmark::State& state, const study::Study& study, int threads) {
  const layout::RowRange rows{0, study::trial_count(study)};
  double samples = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    const TemporaryFolder folder;
    state.ResumeTiming();
    study_run::run_trials(study, {&rows, 1}, folder.path(), {threads, {}}, {});
    samples += study_run::samples_per_trial(study) * static_cast<double>(rows.count);
  }
  count_samples(state, samples);
}

/// Drawing the parameters of the trials of a run.
void time_drawing(benchmark::State& state, const study::Study& study) {
  const std::int64_t trials = study::trial_count(study);
  double samples = 0.0;
  for (auto _ : state) {
    for (std::int64_t index = 0; index < trials; ++index) {
      benchmark::DoNotOptimize(study::study_trial(study, 0, index));
    }
    samples += study_run::samples_per_trial(study) * static_cast<double>(trials);
  }
  count_samples(state, samples);
}

template <class Time>
benchmark::internal::Benchmark* register_timing(const std::string& name, const study::Study& study,
                                                Time time) {
  const auto shared = std::make_shared<const study::Study>(study);
  return benchmark::RegisterBenchmark(name.c_str(),
                                      [shared, time](benchmark::State& state) { time(state, *shared); })
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime();
}

void time_run_on_one_thread(benchmark::State& state, const study::Study& study) {
  time_run(state, study, 1);
}

std::string trials_override(std::int64_t trials) {
  return fmt::format("trials={}", trials);
}

void register_parts(const Workload& workload, const std::string& manifest) {
  const auto trials = static_cast<std::int64_t>(workload.trials.size());
  const study::Study study = workload_study(manifest, {trials_override(trials)});
  register_timing("run/" + workload.name, study, time_run_on_one_thread);
  register_timing("draw/" + workload.name, study, time_drawing);
}

}  // namespace

void register_runner_benchmarks(BenchmarkRun& run) {
  for (const Workload& workload : run.workloads) register_parts(workload, workload.study.name);
  const auto transient = [](std::int64_t trials, std::vector<std::string> overrides) {
    overrides.push_back(trials_override(trials));
    return workload_study("bench-transient", overrides);
  };
  for (const int threads : {1, 2}) {
    const auto time = [threads](benchmark::State& state, const study::Study& study) {
      time_run(state, study, threads);
    };
    register_timing(fmt::format("threads/{}", threads), transient(trials_for_threads, {}), time)
        ->UseRealTime();
  }
  for (const std::int64_t samples : {100, 300, 1000, 3000, 10000}) {
    const std::string hold = fmt::format("command.hold={}", static_cast<double>(samples) / 2000.0);
    register_timing(fmt::format("length/{}", samples), transient(samples_per_run / samples, {hold}),
                    time_run_on_one_thread);
  }
  for (const int target : {1, 3, 10, 30, 100}) {
    register_timing(fmt::format("target/{}", target),
                    transient(trials_per_run, {fmt::format("command.targets.0={}", target)}),
                    time_run_on_one_thread);
  }
  for (const int percent : {25, 50, 100, 150, 200, 250}) {
    constexpr double gain_of_study = 3.85e-5;  // N m/count
    register_timing(
        fmt::format("gain/{}", percent),
        transient(trials_per_run, {fmt::format("controller.ki={}", gain_of_study * percent / 100.0)}),
        time_run_on_one_thread);
  }
  for (const std::int64_t trials : {10, 100, 1000, 10000}) {
    register_timing(fmt::format("trials/{}", trials), transient(trials, {}), time_run_on_one_thread);
  }
  std::vector<std::string> fixed;
  for (std::size_t random = fixed_values.size() + 1; random-- > 0;) {
    const study::Study study = transient(trials_per_run, fixed);
    register_timing(fmt::format("random/{}", random), study, time_run_on_one_thread);
    register_timing(fmt::format("drawing/{}", random), study, time_drawing);
    if (random > 0) fixed.emplace_back(fixed_values[random - 1]);
  }
}

}  // namespace zerocount::testing
