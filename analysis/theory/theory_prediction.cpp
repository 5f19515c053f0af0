#include "analysis/theory/theory_prediction.hpp"

#include <cstddef>
#include <functional>

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include "analysis/text/text.hpp"
#include "analysis/theory/trial_loops.hpp"

namespace zerocount::theory {

TrialPrediction predict(const trial::TrialParameters& parameters) {
  TrialPrediction prediction;
  prediction.applies =
      !is_outside_theory(parameters) && left_out_of_criteria(parameters.plant, parameters.controller).empty();
  if (!prediction.applies) return prediction;
  const friction::FrictionParameters contact =
      friction::friction_at(parameters.friction, parameters.initial.position);
  prediction.bounds =
      integral_gain_bounds(parameters.plant, contact, parameters.encoder, parameters.controller);
  const double ki = parameters.controller.ki;
  prediction.stable = ki > 0.0 && ki < prediction.bounds.stable_below;
  prediction.unstable = ki < 0.0 || ki > prediction.bounds.unstable_above;
  return prediction;
}

void PointPrediction::add(const TrialPrediction& trial) {
  ++trials;
  stable += trial.stable;
  unstable += trial.unstable;
  outside += !trial.applies;
}

PointPrediction PointPrediction::operator+(const PointPrediction& other) const {
  return {trials + other.trials, stable + other.stable, unstable + other.unstable, outside + other.outside};
}

PointPrediction prediction_of(const study::Study& study, layout::RowRange rows) {
  constexpr std::int64_t trials_of_task = 1024;
  using Rows = oneapi::tbb::blocked_range<std::int64_t>;
  const auto add = [&](const Rows& part, PointPrediction prediction) {
    for (std::int64_t row = part.begin(); row < part.end(); ++row) {
      const study::StudyTrial trial = study::study_trial(study, row / study.trials, row % study.trials);
      prediction.add(predict(trial.parameters));
    }
    return prediction;
  };
  return oneapi::tbb::parallel_reduce(Rows(rows.first, rows.end(), trials_of_task), PointPrediction{}, add,
                                      std::plus{});
}

std::vector<PointPrediction> study_predictions(const study::Study& study,
                                               std::span<const PointPrediction> known) {
  std::vector<PointPrediction> predictions(known.begin(), known.end());
  predictions.resize(static_cast<std::size_t>(study::point_count(study)));
  for (std::size_t point = 0; point < predictions.size(); ++point) {
    const std::int64_t first = static_cast<std::int64_t>(point) * study.trials;
    if (predictions[point].trials != study.trials)
      predictions[point] = prediction_of(study, {first, study.trials});
  }
  return predictions;
}

std::int64_t predicted_trials(const PointPrediction& prediction) {
  return prediction.outside == prediction.trials ? 0 : prediction.trials;
}

std::string verdict(const PointPrediction& prediction) {
  if (prediction.trials == 0) return "unknown";
  if (predicted_trials(prediction) == 0) return "not applicable";
  if (prediction.stable == prediction.trials) return "stable";
  if (prediction.unstable == prediction.trials) return "unstable";
  return fmt::format("undecided: (6) holds in {}, (7) exceeded in {}",
                     text::percentage(prediction.stable, prediction.trials),
                     text::percentage(prediction.unstable, prediction.trials));
}

}  // namespace zerocount::theory
