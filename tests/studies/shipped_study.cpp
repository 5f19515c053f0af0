#include "tests/studies/shipped_study.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "core/batch/batch.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::testing {

study::Study shipped_study(const std::string& name, const std::vector<std::string>& settings) {
  return manifest::load_study(std::filesystem::path(ZEROCOUNT_MANIFESTS) / (name + ".yaml"), settings);
}

std::int64_t point_named(const study::Study& study, const std::string& label) {
  const auto found = std::find(study.points.labels.begin(), study.points.labels.end(), label);
  if (found == study.points.labels.end()) throw std::runtime_error(study.name + " has no point " + label);
  return found - study.points.labels.begin();
}

trial::TrialParameters trial_of(const study::Study& study, const std::string& label, std::int64_t index) {
  return study::study_trial(study, point_named(study, label), index).parameters;
}

std::vector<trial::TrialOutcome> outcomes_of(const study::Study& study, const std::string& label,
                                             std::int64_t trials) {
  std::vector<trial::TrialParameters> parameters;
  for (std::int64_t index = 0; index < trials; ++index) parameters.push_back(trial_of(study, label, index));
  std::vector<const trial::TrialParameters*> pointers;
  for (const trial::TrialParameters& trial : parameters) pointers.push_back(&trial);
  std::vector<trial::TrialOutcome> outcomes(parameters.size());
  batch::BatchEngine().run(pointers, outcomes);
  return outcomes;
}

WatchedTrial watched(const trial::TrialParameters& parameters) {
  WatchedTrial trial;
  trial.parameters = parameters;
  trial::TrialObservers observers;
  observers.sample = [&trial](const trial::SampleRecord& sample) { trial.samples.push_back(sample); };
  observers.jerk = [&trial](const trial::Jerk& jerk) { trial.jerks.push_back(jerk); };
  trial.outcome = trial::run_trial(parameters, observers);
  return trial;
}

}  // namespace zerocount::testing
