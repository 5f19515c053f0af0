#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "tests/benchmarks/engines.hpp"
#include "tests/benchmarks/registration.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t trials_checked = 200;  // that do not break away

/// An engine on one workload whose agreement with the reference is checked once, however often it is timed.
struct CheckedEngine {
  TimedEngine engine;
  std::optional<EngineAgreement> agreement;
};

void check(CheckedEngine& checked, const Workload& workload) {
  if (checked.agreement || !checked.engine.record) return;
  checked.agreement = agreement_with_reference(checked.engine.record, workload.study, trials_checked);
  std::cerr << workload.name << ", " << checked.engine.name
            << " against the reference: " << checked.agreement->text() << "\n";
}

void time_engine(benchmark::State& state, const TimedEngine& engine, const Workload& workload) {
  double samples = 0.0;
  for (auto _ : state) {
    engine.simulate(workload);
    samples += engine.copies * workload.samples;
  }
  count_samples(state, samples);
}

void register_engine(const std::string& name, const TimedEngine& engine, const Workload& workload,
                     BenchmarkRun& run) {
  const auto checked = std::make_shared<CheckedEngine>(CheckedEngine{engine, {}});
  const auto time_checked = [checked, &workload, &run](benchmark::State& state) {
    check(*checked, workload);
    if (checked->agreement && !checked->agreement->holds()) {
      run.failed = true;
      state.SkipWithError("does not agree with the reference");
      return;
    }
    time_engine(state, checked->engine, workload);
  };
  benchmark::RegisterBenchmark(name.c_str(), time_checked)->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_engine_benchmarks(BenchmarkRun& run) {
  for (const Workload& workload : run.workloads) {
    for (const TimedEngine& engine : all_engines()) {
      register_engine("engine/" + workload.name + "/" + engine.name, engine, workload, run);
    }
  }
}

}  // namespace zerocount::testing
