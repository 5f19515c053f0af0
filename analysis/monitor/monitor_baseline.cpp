#include "analysis/monitor/monitor_baseline.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"
#include "results/layout/fields.hpp"

namespace zerocount::monitor {
namespace {

constexpr std::int64_t trials_at_a_time = 4096;

/// Whether all trials of the study go to the same targets.
bool has_fixed_targets(const study::Study& study) {
  return std::ranges::none_of(study.columns.inputs, [](const study::InputColumn& column) {
    return column.name.starts_with("command.");
  });
}

}  // namespace

std::vector<MoveLabel> labels_of(const trial::TrialParameters& parameters) {
  std::vector<MoveLabel> labels;
  double before = 0.0;
  for (std::size_t move = 0; move < trial::move_count(parameters); ++move) {
    const auto target = static_cast<double>(trial::target_of_move(parameters, move));
    labels.push_back({.number = static_cast<std::int64_t>(move),
                      .target = target,
                      .direction = static_cast<int>(target > before) - static_cast<int>(target < before)});
    before = target;
  }
  return labels;
}

const Baseline::Column* Baseline::find(std::string_view measure) const {
  const auto found =
      std::ranges::find_if(columns, [&](const Column& column) { return column.measure.name == measure; });
  return found == columns.end() ? nullptr : &*found;
}

Baseline baseline_of(const MoveLog& log) {
  log.require_header();
  if (log.moves() == 0)
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: has no moves; expected a row for each move of the baseline", log.name()));
  Baseline baseline{.name = log.name(),
                    .columns = {},
                    .moves = log.moves(),
                    .labels = log.labels(),
                    .groups = log.groups()};
  for (const MoveLog::Column& column : log.columns())
    baseline.columns.push_back({column.measure, column.unit, column.values});
  return baseline;
}

Baseline baseline_of(const reading::AllTrialsFile& file, const ModelMoves& moves) {
  const study::Study& study = file.study();
  const auto of_trial = static_cast<std::size_t>(file.moves());
  Baseline baseline{.name = file.path().string(),
                    .columns = {},
                    .moves = 0,
                    .is_model = true,
                    .machines = moves.rig        ? 1
                                : study.rigs > 0 ? study.rigs
                                                 : file.header().trials};
  std::vector<const layout::RecordField<trial::MoveOutcome>*> fields;
  for (const auto& field : file.measures()) {
    const std::optional<MonitoredMeasure> measure = measure_named(field.column.name);
    if (!measure) continue;
    fields.push_back(&field);
    baseline.columns.push_back({*measure, parameters::unit_on(file.axis(), field.column.unit), {}});
  }
  const trial::TrialParameters first_trial = study::commanded_trial(study, moves.point, 0).parameters;
  baseline.labels = {.numbered = true,
                     .targeted = true,
                     .target_unit = "count",
                     .count = loop::fine_resolution(first_trial.encoder),
                     .si_unit = parameters::unit_on(file.axis(), "rad")};
  const bool fixed = has_fixed_targets(study);
  std::vector<MoveLabel> labels = labels_of(first_trial);
  const layout::RowRange rows = file.rows_of(moves.point);
  for (std::int64_t first = 0; first < rows.count; first += trials_at_a_time) {
    const std::int64_t count = std::min(trials_at_a_time, rows.count - first);
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes({rows.first + first, count});
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const std::int64_t trial = first + static_cast<std::int64_t>(i / of_trial);
      if (moves.rig && study::rig_of(study, trial) != *moves.rig) continue;
      ++baseline.moves;
      const std::size_t move = i % of_trial;
      if (!fixed && move == 0)
        labels = labels_of(study::commanded_trial(study, moves.point, trial).parameters);
      baseline.labels.moves.push_back(move < labels.size() ? labels[move] : MoveLabel{});
      for (std::size_t column = 0; column < fields.size(); ++column)
        baseline.columns[column].values.push_back(
            ranked_value(baseline.columns[column].measure, layout::value_of(*fields[column], outcomes[i])));
    }
  }
  return baseline;
}

}  // namespace zerocount::monitor
