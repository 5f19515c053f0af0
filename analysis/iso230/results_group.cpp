#include "analysis/iso230/results_group.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/iso230/columns.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/csv.hpp"

namespace zerocount::iso230 {
namespace {

/// The columns of the outcomes that are read.
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

void require_rows(const layout::TableIo& io, std::int64_t rows) {
  if (io.rows() != rows) io.row_scale().fail("it is not of all trials of the study");
}

/// The trials of these rows.
std::vector<SequenceTrial> evaluate(const study::Study& study, const hdf5::Group& root,
                                    const layout::TableIo& outcomes, std::int64_t first, std::int64_t count) {
  std::vector<SequenceTrial> trials;
  const std::vector<trial::MoveOutcome> moves =
      layout::read_records(outcomes, measured_fields(), first, count);
  for (std::int64_t row = first; row < first + count; ++row) {
    const trial::TrialParameters parameters =
        study::study_trial(study, row / study.trials, row % study.trials).parameters;
    const auto begin = static_cast<std::size_t>((row - first) * outcomes.width());
    const std::span<const trial::MoveOutcome> trial =
        std::span(moves).subspan(begin, static_cast<std::size_t>(outcomes.width()));
    try {
      trials.push_back({listed_targets(study.sequence, parameters),
                        trial_repeatability(study.sequence, parameters, trial)});
    } catch (const Failure& failure) {
      throw Failure(failure.code(), fmt::format("{}: trial {}: {}", root.file_name(), row, failure.what()));
    }
  }
  return trials;
}

/// Writes the columns to those of the table from `first_column` on, for `rows` from row `first` on.
template <typename Row>
void write_columns(layout::TableIo& io, std::size_t first_column, const RepeatabilityColumns<Row>& columns,
                   std::int64_t first, const std::vector<Row>& rows) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::vector<double> values;
    for (const Row& row : rows) {
      for (std::size_t target = 0; target < static_cast<std::size_t>(io.width()); ++target)
        values.push_back(columns[i].value(row, target));
    }
    io.column(first_column + i).write(first, std::ssize(rows), values.data());
  }
}

layout::TableIo create_table(hdf5::File& file, const study::Study& study, const layout::Table& table,
                             std::int64_t rows, std::int64_t width) {
  layout::TableIo io = layout::TableIo::create(file, layout::on_axis(table, study.units.axis), rows, width);
  io.number_rows(0);
  return io;
}

void write_trials(hdf5::File& file, const study::Study& study) {
  const std::int64_t rows = study::trial_count(study);
  const layout::TableIo outcomes = open_outcomes(file);
  require_rows(outcomes, rows);
  layout::TableIo axis = create_table(file, study, trial_table_of_axis(), rows, 1);
  layout::TableIo targets =
      create_table(file, study, trial_table_of_targets(), rows, shape_of(study.sequence).targets);
  const std::int64_t at_once = layout::chunk_rows(outcomes.width());
  for (std::int64_t first = 0; first < rows; first += at_once) {
    const std::vector<SequenceTrial> trials =
        evaluate(study, file, outcomes, first, std::min(at_once, rows - first));
    std::vector<std::uint8_t> evaluated;
    evaluated.reserve(trials.size());
    for (const SequenceTrial& trial : trials) evaluated.push_back(trial.values.has_value() ? 1 : 0);
    axis.column(0).write(first, std::ssize(trials), evaluated.data());
    write_columns(axis, 1, trial_axis_columns(), first, trials);
    write_columns(targets, 0, trial_target_columns(), first, trials);
  }
}

void write_points(hdf5::File& file, const study::Study& study, const RepeatabilitySummary& summary) {
  const std::int64_t rows = std::ssize(summary.points);
  layout::TableIo axis = create_table(file, study, point_table_of_axis(), rows, 1);
  write_columns(axis, 0, point_axis_columns(), 0, summary.points);
  layout::TableIo targets = create_table(file, study, point_table_of_targets(), rows, summary.shape.targets);
  write_columns(targets, 0, point_target_columns(), 0, summary.points);
}

/// Rows [first, first + rows) of a column of numbers or flags, [row][second] flattened.
std::vector<double> read_values(const layout::TableIo& io, std::size_t column, std::int64_t first,
                                std::int64_t rows) {
  const auto size = static_cast<std::size_t>(rows * io.width());
  std::vector<double> values(size);
  if (io.column(column).element() == hdf5::Element::float64) {
    io.column(column).read(first, rows, values.data());
    return values;
  }
  std::vector<std::uint8_t> flags(size);
  io.column(column).read(first, rows, flags.data());
  std::copy(flags.begin(), flags.end(), values.begin());
  return values;
}

void export_table(const hdf5::Group& root, const layout::Table& table, reading::CsvFile& csv) {
  const layout::TableIo io = layout::TableIo::open(root, table);
  csv.add(table.rows.name);
  if (table.second) csv.add(table.second->name);
  for (const layout::Column& column : table.columns) {
    std::string name = column.name;
    std::replace(name.begin(), name.end(), '/', '_');
    csv.add(reading::head_with_unit(name, column.unit));
  }
  csv.end_row();
  for (std::int64_t first = 0; first < io.rows(); first += layout::chunk_rows(io.width())) {
    const std::int64_t rows = std::min(layout::chunk_rows(io.width()), io.rows() - first);
    std::vector<std::vector<double>> columns;
    for (std::size_t i = 0; i < table.columns.size(); ++i) columns.push_back(read_values(io, i, first, rows));
    for (std::int64_t i = 0; i < rows * io.width(); ++i) {
      csv.add(first + i / io.width());
      if (table.second) csv.add(i % io.width());
      for (const std::vector<double>& values : columns) csv.add(values[static_cast<std::size_t>(i)]);
      csv.end_row();
    }
  }
}

reading::ExportedTable exported(const char* name, layout::Table table) {
  return {name, [table = std::move(table)](const reading::ResultsFile& file, reading::CsvFile& csv) {
            export_table(hdf5::File::open_to_read(file.path()), table, csv);
          }};
}

/// The trials of one point, column by column.
struct PointReader {
  const layout::TableIo& axis_table;
  const layout::TableIo& target_table;
  std::int64_t first;  ///< row
  std::int64_t trials;

  std::int64_t evaluated() const {
    std::vector<std::uint8_t> flags(static_cast<std::size_t>(trials));
    axis_table.column(0).read(first, trials, flags.data());
    return std::count(flags.begin(), flags.end(), std::uint8_t{1});
  }

  /// [trial], of an axis value.
  std::vector<double> axis(std::size_t source, std::size_t field) const {
    std::vector<double> values(static_cast<std::size_t>(trials));
    axis_table.column(1 + source * axis_fields().size() + field).read(first, trials, values.data());
    return values;
  }

  /// [target][trial], of the column of the table of targets.
  std::vector<std::vector<double>> target_column(std::size_t column) const {
    const auto width = static_cast<std::size_t>(target_table.width());
    std::vector<double> values(static_cast<std::size_t>(trials) * width);
    target_table.column(column).read(first, trials, values.data());
    std::vector<std::vector<double>> by_target(width);
    for (std::size_t i = 0; i < values.size(); ++i) by_target[i % width].push_back(values[i]);
    return by_target;
  }
};

SourceRepeatability source_statistics(const PointReader& reader, std::size_t source, std::size_t targets,
                                      double confidence) {
  SourceRepeatability result;
  for (std::size_t field = 0; field < axis_fields().size(); ++field) {
    result.axis.push_back(statistics_of(reader.axis(source, field), confidence));
  }
  result.targets.resize(targets);
  for (std::size_t field = 0; field < target_fields().size(); ++field) {
    std::vector<std::vector<double>> values =
        reader.target_column(1 + source * target_fields().size() + field);
    for (std::size_t target = 0; target < targets; ++target) {
      result.targets[target].push_back(statistics_of(std::move(values[target]), confidence));
    }
  }
  return result;
}

/// The axis value whose zeros are counted: R, or that of the only direction.
std::size_t overall_repeatability(const SequenceShape& shape) {
  const auto wanted = shape.positive && shape.negative ? &AxisRepeatability::repeatability
                      : shape.positive                 ? &AxisRepeatability::repeatability_positive
                                                       : &AxisRepeatability::repeatability_negative;
  const auto fields = axis_fields();
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [wanted](const auto& field) { return field.value == wanted; });
  return static_cast<std::size_t>(found - fields.begin());
}

PointRepeatability point_statistics(const PointReader& reader, const SequenceShape& shape,
                                    const study::Study& study, double confidence) {
  const std::int64_t trials = study.trials;
  const auto targets = static_cast<std::size_t>(shape.targets);
  constexpr std::size_t encoder = 1;  // of deviation_sources()
  PointRepeatability point;
  point.trials = trials;
  point.evaluated = reader.evaluated();
  if (shape.cycles >= 2) {
    const std::vector<double> values = reader.axis(encoder, overall_repeatability(shape));
    const std::int64_t zero = std::count(values.begin(), values.end(), 0.0);
    point.zero_repeatability = zero;
    point.zero_rate = statistics::rate(zero, trials);
    std::vector<double> is_zero(values.size());
    std::ranges::transform(values, is_zero.begin(), [](double value) { return value == 0.0; });
    point.zero_bounds = study.rigs == 0 ? statistics::clopper_pearson(zero, trials, confidence)
                                        : statistics::clustered_proportion(
                                              statistics::sums_by_rig(is_zero, study.rigs), confidence)
                                              .korn_graubard;
  }
  for (const std::vector<double>& positions : reader.target_column(0)) {
    statistics::Moments& moments = point.positions.emplace_back();
    for (const double position : positions) moments.add(position);
  }
  for (std::size_t source = 0; source < deviation_sources().size(); ++source) {
    point.sources.push_back(source_statistics(reader, source, targets, confidence));
  }
  return point;
}

}  // namespace

void write_repeatability(hdf5::File& file, const study::Study& study) {
  write_trials(file, study);
  write_points(file, study, read_repeatability(file, study));
}

std::vector<reading::ExportedTable> repeatability_exports(const reading::ResultsFile& file) {
  if (!file.root().contains("repeatability")) return {};
  const parameters::AxisKind axis = file.trials()->features().axis;
  return {exported("repeatability_trials.csv", layout::on_axis(trial_table_of_axis(), axis)),
          exported("repeatability_trial_targets.csv", layout::on_axis(trial_table_of_targets(), axis)),
          exported("repeatability_points.csv", layout::on_axis(point_table_of_axis(), axis)),
          exported("repeatability_point_targets.csv", layout::on_axis(point_table_of_targets(), axis))};
}

RepeatabilitySummary read_repeatability(const hdf5::Group& root, const study::Study& study,
                                        double confidence) {
  const layout::TableIo axis = layout::TableIo::open(root, trial_table_of_axis());
  const layout::TableIo targets = layout::TableIo::open(root, trial_table_of_targets());
  RepeatabilitySummary summary{confidence, shape_of(study.sequence), {}, study.units.axis};
  require_rows(axis, study::trial_count(study));
  require_rows(targets, study::trial_count(study));
  if (targets.width() != summary.shape.targets)
    targets.row_scale().fail("it is of another number of targets");
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    const PointReader reader{axis, targets, point * study.trials, study.trials};
    summary.points.push_back(point_statistics(reader, summary.shape, study, confidence));
  }
  return summary;
}

RepeatabilitySummary study_repeatability(const reading::AllTrialsFile& file, const study::Study& study,
                                         double confidence) {
  return read_repeatability(hdf5::File::open_to_read(file.path()), study, confidence);
}

}  // namespace zerocount::iso230
