#include "tests/benchmarks/workloads.hpp"

#include <cstdint>
#include <filesystem>
#include <utility>

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::testing {
namespace {

Workload load_workload(const std::string& name, const std::string& manifest, std::int64_t trials) {
  Workload workload{name, workload_study(manifest), {}, 0.0};
  for (std::int64_t index = 0; index < trials; ++index) {
    workload.trials.push_back(study::study_trial(workload.study, 0, index).parameters);
    workload.samples += static_cast<double>(trial::samples_of_trial(workload.trials.back()));
  }
  return workload;
}

}  // namespace

study::Study workload_study(const std::string& name, const std::vector<std::string>& overrides) {
  return manifest::load_study(std::filesystem::path(ZEROCOUNT_EXPERIMENTS) / (name + ".yaml"), overrides);
}

std::vector<Workload> all_workloads() {
  std::vector<Workload> workloads;
  workloads.push_back(load_workload("W1", "bench-transient", 1024));
  workloads.push_back(load_workload("W2", "bench-creep", 128));
  workloads.push_back(load_workload("W3", "bench-marginal", 256));
  return workloads;
}

}  // namespace zerocount::testing
