#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "runners/trials/study_runner.hpp"
#include "tests/benchmarks/registration.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t trials_for_threads = 200000;  // whose last lanes, each alone, are a small part
constexpr std::int64_t samples_per_run = 1200000;    // where the length of the trial varies

/// Times a whole run except its last step, the joining of shards: drawing, the trials with their measures,
/// writing.
void time_run(benchmark::State& state, const study::Study& study, int threads) {
  const layout::RowRange rows{0, study::trial_count(study)};
  double samples = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    const TemporaryFolder folder;
    state.ResumeTiming();
    trials::run_trials(study, {&rows, 1}, folder.path(), {threads, {}}, {});
    samples += trials::samples_per_trial(study) * static_cast<double>(rows.count);
  }
  count_samples(state, samples);
}

benchmark::internal::Benchmark* register_run(const std::string& name, int threads,
                                             const std::vector<std::string>& overrides) {
  const auto study = std::make_shared<const study::Study>(workload_study("bench-transient", overrides));
  return benchmark::RegisterBenchmark(
             name.c_str(), [study, threads](benchmark::State& state) { time_run(state, *study, threads); })
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime();
}

}  // namespace

void register_runner_benchmarks() {
  for (const int threads : {1, 2})
    register_run(fmt::format("threads/{}", threads), threads, {fmt::format("trials={}", trials_for_threads)})
        ->UseRealTime();
  for (const std::int64_t samples : {100, 300, 1000, 3000, 10000}) {
    const double hold = static_cast<double>(samples) / 2000.0;
    register_run(fmt::format("length/{}", samples), 1,
                 {fmt::format("command.hold={}", hold), fmt::format("trials={}", samples_per_run / samples)});
  }
}

}  // namespace zerocount::testing
