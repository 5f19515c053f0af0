// The executable `benchmarks`: see README.md in this folder.
#include <benchmark/benchmark.h>

#include "results/layout/header.hpp"
#include "tests/benchmarks/registration.hpp"

namespace {

/// Name of the instruction set for which the program is compiled.
const char* instruction_set() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__x86_64__)
  return "SSE2";
#else
  return "not x86-64";
#endif
}

}  // namespace

int main(int argc, char** argv) {
  using namespace zerocount::testing;
  const zerocount::layout::Provenance build = zerocount::layout::current_provenance();
  benchmark::AddCustomContext("cpu", build.cpu);
  benchmark::AddCustomContext("compiler", build.compiler);
  benchmark::AddCustomContext("instruction_set", instruction_set());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  BenchmarkRun run{all_workloads()};
  register_engine_benchmarks(run);
  register_runner_benchmarks();
  register_controller_benchmarks(run);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return run.failed ? 1 : 0;
}
