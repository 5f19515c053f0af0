#include "runners/trials/trial_runner.hpp"

#include <algorithm>
#include <numeric>
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

std::vector<std::int64_t> numbers_of(layout::RowRange rows) {
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(rows.count));
  std::iota(numbers.begin(), numbers.end(), rows.first);
  return numbers;
}

std::vector<shards::TrialResult> results_of(std::span<const std::int64_t> rows) {
  std::vector<shards::TrialResult> results(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) results[i].row = rows[i];
  return results;
}

bool has_ended(const shards::TrialResult& result) {
  return !result.outcome.moves.empty();
}

/// Sums of the theory's predictions for consecutive trials, one sum per design point.
class BlockPredictions {
 public:
  explicit BlockPredictions(std::int64_t trials_of_point, std::int64_t first_row)
      : trials_(trials_of_point), first_point_(first_row / trials_of_point) {}

  void add(std::int64_t row, const study::StudyTrial& trial) {
    const auto point = static_cast<std::size_t>(row / trials_ - first_point_);
    points_.resize(std::max(points_.size(), point + 1));
    points_[point].add(theory::predict(trial.parameters));
  }

  std::vector<theory::PointPrediction>& points() { return points_; }

 private:
  std::int64_t trials_;
  std::int64_t first_point_;
  std::vector<theory::PointPrediction> points_;
};

}  // namespace

bool is_retained(const study::Study& study, std::int64_t index) {
  return std::binary_search(study.retained_trials.begin(), study.retained_trials.end(), index);
}

study::Engine engine_that_runs(const study::Study& study) {
  if (study.engine == study::Engine::reference) return study::Engine::reference;
  constexpr std::int64_t max_examined = 4096;  // trials; each takes some 10 µs to draw
  constexpr std::int64_t max_of_cell = 64;
  const study::TrialIndices indices = study::trial_indices(study);
  const std::int64_t cells = study::point_count(study) * indices.settings.total();
  const std::int64_t draws = study::draw_count(study);
  const std::int64_t of_cell =
      std::min(draws, std::clamp<std::int64_t>(max_examined / cells, 1, max_of_cell));
  for (std::int64_t cell = 0; cell < cells; ++cell) {
    for (std::int64_t i = 0; i < of_cell; ++i) {
      // All points share the draws, so that each cell examines other draws than the one before.
      const std::int64_t trial =
          indices.trial_of((cell * of_cell + i) % draws, cell % indices.settings.total());
      if (batch::runs_in_lanes(study::study_trial(study, cell / indices.settings.total(), trial).parameters))
        return study::Engine::batch;
    }
  }
  return study::Engine::reference;
}

shards::TrialResult run_study_trial(const study::Study& study, std::int64_t row,
                                    const std::stop_token& stop) {
  return run_reference(study, row, trial_of_row(study, row), stop);
}

TrialRunner::TrialRunner(const study::Study& study) : study_(&study), drawer_(study) {
  if (study.engine != study::Engine::batch) return;
  const batch::BatchSettings settings;
  engine_ = std::make_unique<batch::BatchEngine>(settings);
  drawn_.resize(static_cast<std::size_t>(settings.lanes));
}

void TrialRunner::draw(std::int64_t row, const Drawn& drawn, study::StudyTrial& trial) {
  drawer_.draw(row / study_->trials, row % study_->trials, trial);
  if (drawn) drawn(row, trial);
}

std::vector<shards::TrialResult> TrialRunner::run(layout::RowRange rows, const std::stop_token& stop) {
  return run(numbers_of(rows), stop);
}

std::vector<shards::TrialResult> TrialRunner::run(std::span<const std::int64_t> rows,
                                                  const std::stop_token& stop) {
  std::vector<shards::TrialResult> results = results_of(rows);
  run_results(results, stop, {});
  return results;
}

TrialBlock TrialRunner::run_block(layout::RowRange rows, const std::stop_token& stop) {
  std::vector<shards::TrialResult> results = results_of(numbers_of(rows));
  BlockPredictions predictions(study_->trials, rows.first);
  try {
    run_results(results, stop,
                [&](std::int64_t row, const study::StudyTrial& trial) { predictions.add(row, trial); });
    return {std::move(results), std::move(predictions.points())};
  } catch (const trial::Interrupted&) {
    results.erase(std::find_if_not(results.begin(), results.end(), has_ended), results.end());
    std::vector<theory::PointPrediction> of_ended = predictions_of(results);
    return {std::move(results), std::move(of_ended)};
  }
}

std::vector<theory::PointPrediction> TrialRunner::predictions_of(
    std::span<const shards::TrialResult> results) {
  if (results.empty()) return {};
  BlockPredictions predictions(study_->trials, results.front().row);
  study::StudyTrial trial;
  for (const shards::TrialResult& result : results)
    draw(
        result.row, [&](std::int64_t row, const study::StudyTrial& drawn) { predictions.add(row, drawn); },
        trial);
  return std::move(predictions.points());
}

void TrialRunner::run_results(std::vector<shards::TrialResult>& results, const std::stop_token& stop,
                              const Drawn& drawn) {
  if (engine_) return run_in_lanes(stop, drawn, results);
  for (shards::TrialResult& one : results) run_alone(one, drawn, stop);
}

void TrialRunner::run_alone(shards::TrialResult& result, const Drawn& drawn, const std::stop_token& stop) {
  study::StudyTrial trial;
  draw(result.row, drawn, trial);
  result = run_reference(*study_, result.row, std::move(trial), stop);
}

void TrialRunner::run_in_lanes(const std::stop_token& stop, const Drawn& drawn,
                               std::vector<shards::TrialResult>& results) {
  std::vector<shards::TrialResult*> places;
  places.reserve(results.size());
  for (shards::TrialResult& one : results) {
    if (is_retained(*study_, one.row % study_->trials)) {
      run_alone(one, drawn, stop);
    } else {
      places.push_back(&one);
    }
  }
  const auto draw_next = [&](std::size_t trial, std::size_t slot) -> const trial::TrialParameters& {
    shards::TrialResult& result = *places[trial];
    draw(result.row, drawn, drawn_[slot]);
    result.inputs = std::move(drawn_[slot].inputs);
    return drawn_[slot].parameters;
  };
  std::vector<trial::TrialOutcome> outcomes(places.size());
  batch::BatchObservers observers;
  observers.stop = stop;
  observers.jerk = [&](std::size_t trial, const trial::Jerk& jerk) { places[trial]->jerks.push_back(jerk); };
  const auto take_outcomes = [&] {
    for (std::size_t i = 0; i < places.size(); ++i) places[i]->outcome = std::move(outcomes[i]);
  };
  try {
    engine_->run(draw_next, outcomes, observers);
  } catch (const trial::Interrupted&) {
    take_outcomes();
    throw;
  }
  take_outcomes();
}

}  // namespace zerocount::trials
