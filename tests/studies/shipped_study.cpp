#include "tests/studies/shipped_study.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "experiments/manifest/load_study.hpp"

namespace zerocount::testing {

Study shipped_study(const std::string& name, const std::vector<std::string>& settings) {
  return load_study(std::filesystem::path(ZEROCOUNT_MANIFESTS) / (name + ".yaml"), settings);
}

std::int64_t point_named(const Study& study, const std::string& label) {
  const auto found = std::find(study.point_labels.begin(), study.point_labels.end(), label);
  if (found == study.point_labels.end()) throw std::runtime_error(study.name + " has no point " + label);
  return found - study.point_labels.begin();
}

TrialParameters trial_of(const Study& study, const std::string& label, std::int64_t index) {
  return study_trial(study, point_named(study, label), index).parameters;
}

std::vector<TrialOutcome> outcomes_of(const Study& study, const std::string& label, std::int64_t trials) {
  std::vector<TrialOutcome> outcomes;
  for (std::int64_t index = 0; index < trials; ++index) {
    outcomes.push_back(run_trial(trial_of(study, label, index)));
  }
  return outcomes;
}

WatchedTrial watched(const TrialParameters& parameters) {
  WatchedTrial trial;
  trial.parameters = parameters;
  TrialObservers observers;
  observers.sample = [&trial](const SampleRecord& sample) { trial.samples.push_back(sample); };
  observers.jerk = [&trial](const Jerk& jerk) { trial.jerks.push_back(jerk); };
  trial.outcome = run_trial(parameters, observers);
  return trial;
}

}  // namespace zerocount::testing
