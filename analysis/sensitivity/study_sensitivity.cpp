#include <algorithm>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "analysis/sensitivity/output_sensitivity.hpp"
#include "analysis/sensitivity/sensitivity.hpp"
#include "analysis/sensitivity/trial_outputs.hpp"
#include "core/failure/failure.hpp"
#include "experiments/designs/random_key.hpp"
#include "results/layout/header.hpp"

namespace zerocount::sensitivity {
namespace {

std::vector<std::int64_t> points_asked(const reading::StudyFile& file, const SensitivityQuestion& question) {
  const std::int64_t count = file.header().points;
  for (const std::int64_t point : question.points) {
    if (point < 0 || point >= count) {
      throw Failure(ExitCode::bad_input, fmt::format("{}: there is no design point {}; expected 0 to {}",
                                                     file.path().string(), point, count - 1));
    }
  }
  if (!question.points.empty()) return question.points;
  std::vector<std::int64_t> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), std::int64_t{0});
  return all;
}

std::vector<SensitivityOutput> outputs_asked(const SensitivityQuestion& question,
                                             const layout::MeasureTable& measures) {
  std::vector<SensitivityOutput> outputs;
  for (const std::string& name : question.outputs) outputs.push_back(find_sensitivity_output(name, measures));
  if (outputs.empty()) {
    outputs = sensitivity_outputs(measures);
    outputs.resize(2);
  }
  return outputs;
}

// Beyond the highest, resampling would have to go on for minutes to find the bounds.
void check_confidence(double confidence) {
  constexpr double highest = 0.999;
  if (confidence > 0.0 && confidence <= highest) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("a confidence of {}; expected one above 0 and at most {}", confidence, highest));
}

/// The number of trials of a point that are read, its first ones. A saltelli design is read as a whole: its
/// rows are what was paid for.
std::int64_t trials_read(const study::Study& study, const SensitivityQuestion& question) {
  if (study.design == study::Design::saltelli) return study.trials;
  return std::min(study.trials, std::max(question.max_trials, study.rigs));
}

PointInputs point_inputs(const reading::StudyFile& file, const study::Study& study, std::int64_t point,
                         std::int64_t trials) {
  PointInputs inputs{.design = study.design,
                     .factors = study.factors,
                     .inputs = {},
                     .correlated = study::has_dependent_parameters(study),
                     .rigs = study.rigs};
  const layout::RowRange rows{point * file.header().trials, trials};
  for (std::size_t column = 0; column < file.input_columns().size(); ++column) {
    inputs.inputs.push_back({file.input_columns()[column].name, file.input(column, rows)});
  }
  return inputs;
}

}  // namespace

StudySensitivity study_sensitivity(const reading::StudyFile& file, const SensitivityQuestion& question) {
  check_confidence(question.confidence);
  const layout::FileHeader& header = file.header();
  const study::Study study = layout::recorded_study(header, file.path());
  const std::vector<SensitivityOutput> outputs = outputs_asked(question, file.table());
  const std::vector<std::string> labels = file.point_labels();
  // The resampling is the same for all outputs and points, as the trials are.
  const random::RandomStream bootstrap{designs::random_key(header.seed, "sensitivity/bootstrap"), 0};

  StudySensitivity sensitivity{.name = header.name,
                               .from_saltelli = study.design == study::Design::saltelli,
                               .confidence = question.confidence,
                               .points = {}};
  const std::vector<std::int64_t> points = points_asked(file, question);
  const std::int64_t trials = trials_read(study, question);
  const std::int64_t all = std::ssize(points) * std::ssize(outputs);
  std::int64_t done = 0;
  for (const std::int64_t point : points) {
    PointSensitivity at_point{point, labels.at(static_cast<std::size_t>(point)), {}};
    const PointInputs inputs = point_inputs(file, study, point, trials);
    for (const SensitivityOutput& output : outputs) {
      OutputSensitivity result = output_sensitivity(
          inputs, output, trial_outputs(file, study, point, trials, output), question.confidence, bootstrap);
      if (trials < study.trials && study.rigs == 0)
        result.notes.push_back(fmt::format("the first {} of {} trials are used", trials, study.trials));
      result.unit = parameters::unit_on(study.units.axis, result.unit);
      result.meaning = parameters::text_on(study.units.axis, result.meaning);
      at_point.outputs.push_back(std::move(result));
      if (question.progress) question.progress(++done, all);
    }
    sensitivity.points.push_back(std::move(at_point));
  }
  return sensitivity;
}

bool any_estimated(const StudySensitivity& sensitivity) {
  return std::any_of(sensitivity.points.begin(), sensitivity.points.end(), [](const auto& point) {
    return std::any_of(point.outputs.begin(), point.outputs.end(),
                       [](const OutputSensitivity& output) { return output.estimated; });
  });
}

}  // namespace zerocount::sensitivity
