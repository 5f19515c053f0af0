#pragma once

#include <vector>

#include <benchmark/benchmark.h>

#include "tests/benchmarks/workloads.hpp"

namespace zerocount::testing {

/// The settings that all benchmarks of a run have in common.
struct BenchmarkRun {
  std::vector<Workload> workloads;
  bool failed{false};  ///< set if an engine does not agree with the reference engine
};

/// Sets the benchmark's counter per_sample: the time per sample of a trial.
/// @param samples number of samples that one iteration simulates
inline void count_samples(benchmark::State& state, double samples) {
  state.counters["per_sample"] =
      benchmark::Counter(samples, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// engine/<workload>/<engine>: whole trials on one thread, drawn beforehand. Every engine is checked against
/// the reference before it is timed; where it does not agree it is not timed, and the run has failed.
void register_engine_benchmarks(BenchmarkRun& run);

/// threads/…, length/…: a run with its drawing and writing, and how its cost grows.
void register_runner_benchmarks();

/// controller/<example>: a sample of the controller with each of examples/controllers, by turns with the same
/// law built in. The counters: per_sample of the example, built_in_ns, their difference call_ns and their
/// ratio.
void register_controller_benchmarks(BenchmarkRun& run);

}  // namespace zerocount::testing
