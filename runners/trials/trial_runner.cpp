#include "runners/trials/trial_runner.hpp"

#include <algorithm>
#include <utility>

#include "core/trial/trial.hpp"
#include "runners/trials/study_runner.hpp"

namespace zerocount::trials {
namespace {

study::StudyTrial trial_of_row(const study::Study& study, std::int64_t row) {
  return study::study_trial(study, row / study.trials, row % study.trials);
}

shards::TrialResult run_reference(const study::Study& study, std::int64_t row, study::StudyTrial trial,
                                  const std::stop_token& stop) {
  shards::TrialResult result;
  result.row = row;
  result.inputs = std::move(trial.inputs);
  trial::TrialObservers observers;
  observers.stop = stop;
  observers.jerk = [&](const trial::Jerk& jerk) { result.jerks.push_back(jerk); };
  if (is_retained(study, row % study.trials)) {
    observers.sample = [&](const trial::SampleRecord& record) { result.trace.push_back(record); };
  }
  result.outcome = trial::run_trial(trial.parameters, observers);
  return result;
}

}  // namespace

bool is_retained(const study::Study& study, std::int64_t index) {
  return std::binary_search(study.retained_trials.begin(), study.retained_trials.end(), index);
}

shards::TrialResult run_study_trial(const study::Study& study, std::int64_t row,
                                    const std::stop_token& stop) {
  return run_reference(study, row, trial_of_row(study, row), stop);
}

TrialRunner::TrialRunner(const study::Study& study) : study_(&study) {
  if (study.engine != study::Engine::batch) return;
  const batch::BatchSettings settings;
  engine_ = std::make_unique<batch::BatchEngine>(settings);
  drawn_.resize(static_cast<std::size_t>(settings.lanes));
}

study::StudyTrial TrialRunner::next_trial(std::int64_t row, TrialBlock& block) {
  study::StudyTrial trial = trial_of_row(*study_, row);
  const std::int64_t first_point = block.results.front().row / study_->trials;
  const auto point = static_cast<std::size_t>(row / study_->trials - first_point);
  block.predictions.resize(std::max(block.predictions.size(), point + 1));
  block.predictions[point].add(theory::predict(trial.parameters));
  return trial;
}

std::vector<shards::TrialResult> TrialRunner::run(layout::RowRange rows, const std::stop_token& stop) {
  return run_block(rows, stop).results;
}

TrialBlock TrialRunner::run_block(layout::RowRange rows, const std::stop_token& stop) {
  TrialBlock block;
  block.results.resize(static_cast<std::size_t>(rows.count));
  if (rows.count > 0) block.results.front().row = rows.first;
  if (engine_) {
    run_in_lanes(rows, stop, block);
    return block;
  }
  for (std::int64_t row = rows.first; row < rows.end(); ++row)
    block.results[static_cast<std::size_t>(row - rows.first)] =
        run_reference(*study_, row, next_trial(row, block), stop);
  return block;
}

void TrialRunner::run_in_lanes(layout::RowRange rows, const std::stop_token& stop, TrialBlock& block) {
  std::vector<shards::TrialResult>& results = block.results;
  std::vector<std::size_t> places;  // indices of the trials in the results
  places.reserve(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::int64_t row = rows.first + static_cast<std::int64_t>(i);
    results[i].row = row;
    if (is_retained(*study_, row % study_->trials)) {
      results[i] = run_reference(*study_, row, next_trial(row, block), stop);
    } else {
      places.push_back(i);
    }
  }
  const auto draw = [&](std::size_t trial, std::size_t slot) -> const trial::TrialParameters& {
    shards::TrialResult& result = results[places[trial]];
    drawn_[slot] = next_trial(result.row, block);
    result.inputs = std::move(drawn_[slot].inputs);
    return drawn_[slot].parameters;
  };
  std::vector<trial::TrialOutcome> outcomes(places.size());
  batch::BatchObservers observers;
  observers.stop = stop;
  observers.jerk = [&](std::size_t trial, const trial::Jerk& jerk) {
    results[places[trial]].jerks.push_back(jerk);
  };
  engine_->run(draw, outcomes, observers);
  for (std::size_t i = 0; i < places.size(); ++i) results[places[i]].outcome = std::move(outcomes[i]);
}

}  // namespace zerocount::trials
