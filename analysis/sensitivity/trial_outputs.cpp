#include "analysis/sensitivity/trial_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/measures/trial_value.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::sensitivity {
namespace {

/// Whether every move ran to its end, and its motion is known. Qualities, and times that may be later than
/// any, need not that.
bool is_whole(std::span<const trial::MoveOutcome> moves) {
  return std::all_of(moves.begin(), moves.end(), [](const trial::MoveOutcome& move) {
    return !move.stopped && move.outcome != trial::Outcome::nonfinite;
  });
}

}  // namespace

double move_duration(const trial::TrialParameters& trial) {
  const double rate = trial.controller.sample_rate;
  return std::round(trial.command.hold * rate) / rate;
}

std::vector<SensitivityOutput> sensitivity_outputs(const layout::MeasureTable& measures) {
  std::vector<SensitivityOutput> outputs;
  for (const layout::Measure* measure :
       layout::measures_of(measures, layout::ReportOrder::outputs,
                           [](const layout::Measure& m) { return m.output.has_value(); })) {
    outputs.push_back({measure->output->name, measure->field.column.unit, measure->output->meaning, measure});
  }
  return outputs;
}

SensitivityOutput find_sensitivity_output(std::string_view name, const layout::MeasureTable& measures) {
  std::vector<std::string_view> names;
  for (const SensitivityOutput& output : sensitivity_outputs(measures)) {
    if (output.name == name) return output;
    names.push_back(output.name);
  }
  throw Failure(ExitCode::bad_input, fmt::format("there is no output '{}' of a trial; expected one of {}",
                                                 name, fmt::join(names, ", ")));
}

TrialOutputs trial_outputs(const reading::StudyFile& file, const study::Study& study, std::int64_t point,
                           std::int64_t trials, const SensitivityOutput& output) {
  const layout::Measure& measure = *output.measure;
  const bool of_any_trial = layout::is_quality(measure) || measure.values.nan_is_late;
  const layout::RowRange rows{point * file.header().trials, trials};
  TrialOutputs outputs;
  measures::visit_trials(file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
    double duration = statistics::unknown;
    // Only if a move never arrived are the parameters of its trial needed.
    const auto late = [&] {
      if (std::isnan(duration))
        duration = move_duration(study::study_trial(study, point, row - rows.first).parameters);
      return duration;
    };
    const bool has_value = measures::has_targets(measure, moves) && (of_any_trial || is_whole(moves));
    outputs.values.push_back(has_value ? measures::value_of_trial(measure, moves, late)
                                       : statistics::unknown);
    outputs.never_arrived += !std::isnan(duration);
  });
  return outputs;
}

}  // namespace zerocount::sensitivity
