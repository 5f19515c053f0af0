#include "analysis/sensitivity/trial_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/measures/trial_value.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Whether every move ran to its end, and its motion is known. Qualities, and times that may be later than
/// any, need not that.
bool is_whole(std::span<const MoveOutcome> moves) {
  return std::all_of(moves.begin(), moves.end(), [](const MoveOutcome& move) {
    return !move.stopped && move.outcome != Outcome::nonfinite;
  });
}

}  // namespace

double move_duration(const TrialParameters& trial) {
  const double rate = trial.controller.sample_rate;
  return std::round(trial.command.hold * rate) / rate;
}

std::vector<SensitivityOutput> sensitivity_outputs(const MeasureTable& measures) {
  std::vector<SensitivityOutput> outputs;
  for (const Measure* measure :
       measures_of(measures, ReportOrder::outputs, [](const Measure& m) { return m.output.has_value(); })) {
    outputs.push_back({measure->output->name, measure->field.column.unit, measure->output->meaning, measure});
  }
  return outputs;
}

SensitivityOutput find_sensitivity_output(std::string_view name, const MeasureTable& measures) {
  std::vector<std::string_view> names;
  for (const SensitivityOutput& output : sensitivity_outputs(measures)) {
    if (output.name == name) return output;
    names.push_back(output.name);
  }
  throw Failure(ExitCode::bad_input, fmt::format("there is no output '{}' of a trial; expected one of {}",
                                                 name, fmt::join(names, ", ")));
}

TrialOutputs trial_outputs(const StudyFile& file, const Study& study, std::int64_t point,
                           const SensitivityOutput& output) {
  const Measure& measure = *output.measure;
  const bool of_any_trial = is_quality(measure) || measure.values.nan_is_late;
  const std::int64_t trials = file.header().trials;
  const auto moves = static_cast<std::size_t>(file.moves());
  const std::int64_t at_once = chunk_rows(file.moves());
  TrialOutputs outputs;
  for (std::int64_t first = 0; first < trials; first += at_once) {
    const RowRange block{point * trials + first, std::min(at_once, trials - first)};
    const std::vector<MoveOutcome> outcomes = file.outcomes(block);
    for (std::int64_t i = 0; i < block.count; ++i) {
      const auto of_trial = std::span(outcomes).subspan(static_cast<std::size_t>(i) * moves, moves);
      double duration = none;
      // Only where a move never arrived do the parameters of its trial have to be worked out.
      const auto late = [&] {
        if (std::isnan(duration)) duration = move_duration(study_trial(study, point, first + i).parameters);
        return duration;
      };
      const bool has_value = has_targets(measure, of_trial) && (of_any_trial || is_whole(of_trial));
      outputs.values.push_back(has_value ? value_of_trial(measure, of_trial, late) : none);
      outputs.never_arrived += !std::isnan(duration);
    }
  }
  return outputs;
}

}  // namespace zerocount
