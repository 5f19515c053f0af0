#include "runners/study_run/trial_runner.hpp"

#include <algorithm>
#include <utility>

#include "core/trial/trial.hpp"
#include "runners/study_run/study_runner.hpp"

namespace zerocount {
namespace {

bool retained(const Study& study, std::int64_t index) {
  return std::binary_search(study.retained_trials.begin(), study.retained_trials.end(), index);
}

StudyTrial trial_of_row(const Study& study, std::int64_t row) {
  return study_trial(study, row / study.trials, row % study.trials);
}

}  // namespace

TrialResult run_study_trial(const Study& study, std::int64_t row) {
  StudyTrial trial = trial_of_row(study, row);
  TrialResult result;
  result.row = row;
  result.inputs = std::move(trial.inputs);
  TrialObservers observers;
  observers.jerk = [&](const Jerk& jerk) { result.jerks.push_back(jerk); };
  if (retained(study, row % study.trials)) {
    observers.sample = [&](const SampleRecord& record) { result.trace.push_back(record); };
  }
  result.outcome = run_trial(trial.parameters, observers);
  return result;
}

TrialRunner::TrialRunner(const Study& study) : study_(&study) {
  if (study.engine == Engine::batch) engine_ = std::make_unique<BatchEngine>();
}

std::vector<TrialResult> TrialRunner::run(RowRange rows) {
  if (engine_) return run_in_lanes(rows);
  std::vector<TrialResult> results;
  results.reserve(static_cast<std::size_t>(rows.count));
  for (std::int64_t row = rows.first; row < rows.end(); ++row)
    results.push_back(run_study_trial(*study_, row));
  return results;
}

std::vector<TrialResult> TrialRunner::run_in_lanes(RowRange rows) {
  std::vector<TrialResult> results(static_cast<std::size_t>(rows.count));
  std::vector<StudyTrial> trials;
  std::vector<std::size_t> places;  // indices of the trials in the results
  trials.reserve(results.size());
  places.reserve(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::int64_t row = rows.first + static_cast<std::int64_t>(i);
    if (retained(*study_, row % study_->trials)) {
      results[i] = run_study_trial(*study_, row);
      continue;
    }
    results[i].row = row;
    trials.push_back(trial_of_row(*study_, row));
    results[i].inputs = std::move(trials.back().inputs);
    places.push_back(i);
  }
  std::vector<const TrialParameters*> parameters;
  parameters.reserve(trials.size());
  for (const StudyTrial& trial : trials) parameters.push_back(&trial.parameters);
  std::vector<TrialOutcome> outcomes(trials.size());
  BatchObservers observers;
  observers.jerk = [&](std::size_t trial, const Jerk& jerk) { results[places[trial]].jerks.push_back(jerk); };
  engine_->run(parameters, outcomes, observers);
  for (std::size_t i = 0; i < trials.size(); ++i) results[places[i]].outcome = std::move(outcomes[i]);
  return results;
}

}  // namespace zerocount
