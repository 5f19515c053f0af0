#include "analysis/iso230/repeatability_file.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <fmt/format.h>

#include "analysis/iso230/repeatability_fields.hpp"
#include "analysis/iso230/repeatability_layout.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::iso230 {
namespace {

/// What is read of the outcomes.
const std::vector<layout::RecordField<trial::MoveOutcome>>& measured_fields() {
  static const std::vector<layout::RecordField<trial::MoveOutcome>> fields = [] {
    std::vector<layout::RecordField<trial::MoveOutcome>> kept;
    for (const layout::RecordField<trial::MoveOutcome>& field : layout::outcome_fields()) {
      const std::string& name = field.column.name;
      if (name == "outcome" || name == "final_position" || name == "final_error") kept.push_back(field);
    }
    return kept;
  }();
  return fields;
}

layout::TableIo open_outcomes(const hdf5::Group& root) {
  layout::Table table = layout::outcome_table();
  table.columns.clear();
  for (const layout::RecordField<trial::MoveOutcome>& field : measured_fields())
    table.columns.push_back(field.column);
  return layout::TableIo::open(root, table);
}

/// The values of some trials: a vector for each numeric column of the two tables of trials.
struct TrialValues {
  std::vector<std::uint8_t> evaluated;
  std::vector<std::vector<double>> axis;
  std::vector<std::vector<double>> targets;  ///< [column], [trial][target] flattened

  void add(const std::optional<TrialRepeatability>& trial, std::span<const double> positions) {
    evaluated.push_back(trial.has_value() ? 1 : 0);
    std::size_t column = 0;
    for (const DeviationSource& source : deviation_sources()) {
      for (const auto& field : axis_fields()) {
        axis[column++].push_back(trial ? ((*trial).*source.values).axis.*field.value : statistics::unknown);
      }
    }
    targets.front().insert(targets.front().end(), positions.begin(), positions.end());
    column = 1;
    for (const DeviationSource& source : deviation_sources()) {
      for (const auto& field : target_fields()) {
        for (std::size_t target = 0; target < positions.size(); ++target) {
          const double value =
              trial ? ((*trial).*source.values).targets[target].*field.value : statistics::unknown;
          targets[column].push_back(value);
        }
        ++column;
      }
    }
  }
};

/// The values of the trials of these rows.
TrialValues evaluate(const study::Study& study, const hdf5::Group& root, const layout::TableIo& outcomes,
                     std::int64_t first, std::int64_t count) {
  const std::size_t sources = deviation_sources().size();
  TrialValues values;
  values.axis.resize(sources * axis_fields().size());
  values.targets.resize(1 + sources * target_fields().size());
  const std::vector<trial::MoveOutcome> moves =
      layout::read_records(outcomes, measured_fields(), first, count);
  for (std::int64_t row = first; row < first + count; ++row) {
    const trial::TrialParameters parameters =
        study::study_trial(study, row / study.trials, row % study.trials).parameters;
    const auto begin = static_cast<std::size_t>((row - first) * outcomes.width());
    const std::span<const trial::MoveOutcome> trial =
        std::span(moves).subspan(begin, static_cast<std::size_t>(outcomes.width()));
    try {
      values.add(trial_repeatability(study.sequence, parameters, trial),
                 listed_targets(study.sequence, parameters));
    } catch (const Failure& failure) {
      throw Failure(failure.code(), fmt::format("{}: trial {}: {}", root.file_name(), row, failure.what()));
    }
  }
  return values;
}

void write_trials(hdf5::File& file, const study::Study& study, const SequenceShape& shape) {
  const std::int64_t rows = study::trial_count(study);
  const layout::TableIo outcomes = open_outcomes(file);
  if (outcomes.rows() != rows) outcomes.row_scale().fail("it is not of all trials of the study");
  layout::TableIo axis =
      layout::TableIo::create(file, layout::on_axis(trial_table_of_axis(), study.units.axis), rows, 1);
  layout::TableIo targets = layout::TableIo::create(
      file, layout::on_axis(trial_table_of_targets(), study.units.axis), rows, shape.targets);
  axis.number_rows(0);
  targets.number_rows(0);
  const std::int64_t at_once = layout::chunk_rows(outcomes.width());
  for (std::int64_t first = 0; first < rows; first += at_once) {
    const std::int64_t count = std::min(at_once, rows - first);
    const TrialValues values = evaluate(study, file, outcomes, first, count);
    axis.column(0).write(first, count, values.evaluated.data());
    for (std::size_t i = 0; i < values.axis.size(); ++i) {
      axis.column(1 + i).write(first, count, values.axis[i].data());
    }
    for (std::size_t i = 0; i < values.targets.size(); ++i) {
      targets.column(i).write(first, count, values.targets[i].data());
    }
  }
}

/// Writes a column of a table of points: `value(point, target)`; of a table without targets, target 0.
template <typename Value>
void write_column(layout::TableIo& io, std::size_t column, std::span<const PointRepeatability> points,
                  const Value& value) {
  std::vector<double> values;
  for (const PointRepeatability& point : points) {
    for (std::size_t target = 0; target < static_cast<std::size_t>(io.width()); ++target) {
      values.push_back(value(point, target));
    }
  }
  io.column(column).write(0, io.rows(), values.data());
}

void write_points_of_axis(hdf5::File& file, const RepeatabilitySummary& summary) {
  const std::vector<PointRepeatability>& points = summary.points;
  layout::TableIo io = layout::TableIo::create(file, layout::on_axis(point_table_of_axis(), summary.axis),
                                               std::ssize(points), 1);
  io.number_rows(0);
  std::size_t column = 0;
  for (const text::ReportField<PointRepeatability>& field : point_repeatability_fields()) {
    write_column(io, column++, points,
                 [&](const PointRepeatability& p, std::size_t) { return field.value(p); });
  }
  for (std::size_t source = 0; source < deviation_sources().size(); ++source) {
    for (std::size_t field = 0; field < axis_fields().size(); ++field) {
      for (const ValueStatisticField& statistic : value_statistic_fields()) {
        write_column(io, column++, points, [&](const PointRepeatability& p, std::size_t) {
          return statistic.value(p.sources[source].axis[field]);
        });
      }
    }
  }
}

void write_points_of_targets(hdf5::File& file, const RepeatabilitySummary& summary) {
  const std::vector<PointRepeatability>& points = summary.points;
  layout::TableIo io = layout::TableIo::create(file, layout::on_axis(point_table_of_targets(), summary.axis),
                                               std::ssize(points), summary.shape.targets);
  io.number_rows(0);
  std::size_t column = 0;
  using P = const PointRepeatability&;
  write_column(io, column++, points, [](P p, std::size_t target) { return p.positions[target].min; });
  write_column(io, column++, points, [](P p, std::size_t target) { return p.positions[target].max; });
  for (std::size_t source = 0; source < deviation_sources().size(); ++source) {
    for (std::size_t field = 0; field < target_fields().size(); ++field) {
      for (const ValueStatisticField& statistic : value_statistic_fields()) {
        if (!statistic.of_targets) continue;
        write_column(io, column++, points, [&](P p, std::size_t target) {
          return statistic.value(p.sources[source].targets[target][field]);
        });
      }
    }
  }
}

}  // namespace

void write_repeatability(hdf5::File& file, const study::Study& study) {
  write_trials(file, study, shape_of(study.sequence));
  const RepeatabilitySummary summary = read_repeatability(file, study);
  write_points_of_axis(file, summary);
  write_points_of_targets(file, summary);
}

}  // namespace zerocount::iso230
