#include "tests/core/batch/bench_trials.hpp"

#include <filesystem>

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::testing {

std::vector<trial::TrialParameters> bench_trials(const std::string& name, std::int64_t first,
                                                 std::int64_t count,
                                                 const std::vector<std::string>& overrides) {
  const study::Study study =
      manifest::load_study(std::filesystem::path(ZEROCOUNT_EXPERIMENTS) / (name + ".yaml"), overrides);
  std::vector<trial::TrialParameters> trials;
  for (std::int64_t index = first; index < first + count; ++index)
    trials.push_back(study::study_trial(study, 0, index).parameters);
  return trials;
}

}  // namespace zerocount::testing
