#include "analysis/trials/iso230/results_group.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/trials/iso230/columns.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/export.hpp"

namespace zerocount::iso230 {
namespace {

using OutcomeFields = std::vector<layout::RecordField<trial::MoveOutcome>>;

/// The columns of the moves' outcomes that must be read from the file to compute the ISO 230-2 quantities.
OutcomeFields measured_fields(const study::StudyFeatures& features) {
  constexpr std::array<std::string_view, 5> read{"outcome", "final_position", "final_error", "true_error",
                                                 "load_true_error"};
  OutcomeFields fields = layout::outcome_fields({.load_error = features.load_error});
  std::erase_if(fields, [&](const auto& field) {
    return std::ranges::find(read, std::string_view(field.column.name)) == read.end();
  });
  return fields;
}

layout::TableReader open_outcomes(const hdf5::Group& root, const OutcomeFields& fields) {
  layout::Table table = layout::outcome_table();
  table.columns.clear();
  for (const layout::RecordField<trial::MoveOutcome>& field : fields) table.columns.push_back(field.column);
  return layout::TableReader::open(root, table);
}

/// The kinds of deviation of the study for which the file has values. Files of earlier builds have none for a
/// mass whose encoder does not close the loop.
const DeviationSources& stored_sources(const hdf5::Group& root, const study::StudyFeatures& features) {
  const DeviationSources& sources = deviation_sources(features);
  const hdf5::Group trials = root.open_group("repeatability").open_group("trial");
  const bool has_all = std::ranges::all_of(
      sources, [&](const DeviationSource& source) { return trials.contains(source.name); });
  return has_all ? sources : deviation_sources({});
}

/// Finds whether the trials of a design point have a second mass, and which mass closes the loop. Trials of a
/// point differ in this only between settings.
/// @param number index of the point
void find_masses(const study::Study& study, std::int64_t number, PointRepeatability& point) {
  bool differ = false;
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting) {
    const std::int64_t trial = setting * std::max<std::int64_t>(study.machines, 1);  // TrialIndices
    const motion::PlantParameters plant = study::commanded_trial(study, number, trial).parameters.plant;
    if (!motion::has_load(plant)) continue;
    differ = differ || (point.has_load && point.closing != plant.load.encoder);
    point.has_load = true;
    point.closing = plant.load.encoder;
  }
  if (differ) point.closing.reset();
}

void require_rows(const auto& io, std::int64_t rows) {
  if (io.rows() != rows) io.row_scale().fail("it does not hold all trials of the study");
}

/// The ISO 230-2 quantities of the trials in the rows from `first` to `first + count − 1` of the file.
std::vector<SequenceTrial> evaluate(const study::Study& study, const hdf5::Group& root, const auto& outcomes,
                                    const OutcomeFields& fields, std::int64_t first, std::int64_t count) {
  std::vector<SequenceTrial> trials;
  const std::vector<trial::MoveOutcome> moves = layout::read_records(outcomes, fields, first, count);
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

/// Writes rows of a table to the file, the first one as row `first`.
template <typename Row>
void write_rows(layout::TableIo& io, const RepeatabilityTable<Row>& table, std::int64_t first,
                const std::vector<Row>& rows) {
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    std::vector<double> values;
    for (const Row& row : rows) {
      for (std::size_t target = 0; target < static_cast<std::size_t>(io.width()); ++target)
        values.push_back(table.values[i](row, target));
    }
    if (io.column(i).element() == hdf5::Element::float64) {
      io.column(i).write(first, std::ssize(rows), values.data());
    } else {
      const std::vector<std::uint8_t> flags(values.begin(), values.end());
      io.column(i).write(first, std::ssize(rows), flags.data());
    }
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
  const OutcomeFields fields = measured_fields(study.features);
  const layout::TableReader outcomes = open_outcomes(file, fields);
  require_rows(outcomes, rows);
  const DeviationSources& sources = deviation_sources(study.features);
  const RepeatabilityTable<SequenceTrial> of_axis = trial_axis_table(sources);
  const RepeatabilityTable<SequenceTrial> of_targets = trial_target_table(sources);
  layout::TableIo axis = create_table(file, study, of_axis.table, rows, 1);
  layout::TableIo targets =
      create_table(file, study, of_targets.table, rows, shape_of(study.sequence).targets);
  const std::int64_t at_once = layout::chunk_rows(outcomes.width());
  for (std::int64_t first = 0; first < rows; first += at_once) {
    const std::vector<SequenceTrial> trials =
        evaluate(study, file, outcomes, fields, first, std::min(at_once, rows - first));
    write_rows(axis, of_axis, first, trials);
    write_rows(targets, of_targets, first, trials);
  }
}

void write_points(hdf5::File& file, const study::Study& study, const RepeatabilitySummary& summary) {
  const auto write = [&](const RepeatabilityTable<PointRepeatability>& table, std::int64_t width) {
    layout::TableIo io = create_table(file, study, table.table, std::ssize(summary.points), width);
    write_rows(io, table, 0, summary.points);
  };
  write(point_axis_table(*summary.sources), 1);
  write(point_target_table(*summary.sources), summary.shape.targets);
}

/// Values of the rows [first, first + rows) of a column of numbers or flags, as [row][second index]
/// flattened.
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

/// The rows of one design point in a table of trials of the results file.
struct TrialsOfPoint {
  const layout::TableIo& table;
  std::int64_t first;  ///< Index of the first row of the design point in the table.
  std::int64_t trials;

  /// [target][trial] Values of the column with this index. A table of the axis has a single target.
  std::vector<std::vector<double>> column(std::size_t index) const {
    const auto width = static_cast<std::size_t>(table.width());
    std::vector<std::vector<double>> targets(width);
    const std::vector<double> values = read_values(table, index, first, trials);
    for (std::size_t i = 0; i < values.size(); ++i) targets[i % width].push_back(values[i]);
    return targets;
  }

  /// [target][field] Statistics of the `fields` quantities that are computed from one kind of deviation.
  /// @param source index of the kind of deviation. The first column of a table is not one of the quantities.
  std::vector<std::vector<ValueStatistics>> statistics(std::size_t source, std::size_t fields,
                                                       double confidence) const {
    std::vector<std::vector<ValueStatistics>> targets(static_cast<std::size_t>(table.width()));
    for (std::size_t field = 0; field < fields; ++field) {
      std::vector<std::vector<double>> values = column(1 + source * fields + field);
      for (std::size_t target = 0; target < targets.size(); ++target)
        targets[target].push_back(statistics_of(std::move(values[target]), confidence));
    }
    return targets;
  }
};

/// Index of the axis quantity whose zeros are counted: R, or with approaches from one side only R↑ or R↓.
std::size_t overall_repeatability(const SequenceShape& shape) {
  const auto wanted = shape.positive && shape.negative ? &AxisRepeatability::repeatability
                      : shape.positive                 ? &AxisRepeatability::repeatability_positive
                                                       : &AxisRepeatability::repeatability_negative;
  const auto fields = axis_fields();
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [wanted](const auto& field) { return field.value == wanted; });
  return static_cast<std::size_t>(found - fields.begin());
}

PointRepeatability point_statistics(const TrialsOfPoint& axis, const TrialsOfPoint& targets,
                                    const RepeatabilitySummary& summary, const study::Study& study) {
  constexpr std::size_t encoder = 1;  // of deviation_sources()
  const SequenceShape& shape = summary.shape;
  const double confidence = summary.confidence;
  PointRepeatability point;
  point.trials = study.trials;
  point.evaluated = std::ranges::count(axis.column(0)[0], 1.0);
  if (shape.cycles >= 2) {
    std::vector<double> is_zero =
        axis.column(1 + encoder * axis_fields().size() + overall_repeatability(shape))[0];
    for (double& value : is_zero) value = value == 0.0 ? 1.0 : 0.0;
    const std::int64_t zero = std::ranges::count(is_zero, 1.0);
    point.zero_repeatability = zero;
    point.zero_rate = statistics::rate(zero, study.trials);
    point.zero_bounds = study.machines == 0
                            ? statistics::clopper_pearson(zero, study.trials, confidence)
                            : statistics::clustered_proportion(
                                  statistics::sums_by_machine(is_zero, study.machines), confidence)
                                  .korn_graubard;
  }
  for (const std::vector<double>& positions : targets.column(0)) {
    statistics::Moments& moments = point.positions.emplace_back();
    for (const double position : positions) moments.add(position);
  }
  for (std::size_t source = 0; source < summary.sources->size(); ++source)
    point.sources.push_back({axis.statistics(source, axis_fields().size(), confidence)[0],
                             targets.statistics(source, target_fields().size(), confidence)});
  return point;
}

}  // namespace

void write_repeatability(hdf5::File& file, const study::Study& study) {
  write_trials(file, study);
  write_points(file, study, read_repeatability(file, study));
}

std::vector<reading::ExportedTable> repeatability_exports(const reading::ResultsFile& file) {
  if (!file.root().contains("repeatability")) return {};
  const DeviationSources& sources = stored_sources(file.root(), file.study().features);
  const auto table = [&](const char* name, const layout::Table& rows) {
    return exported(name, layout::on_axis(rows, file.trials()->features().axis));
  };
  return {table("repeatability_trials.csv", trial_axis_table(sources).table),
          table("repeatability_trial_targets.csv", trial_target_table(sources).table),
          table("repeatability_points.csv", point_axis_table(sources).table),
          table("repeatability_point_targets.csv", point_target_table(sources).table)};
}

RepeatabilitySummary read_repeatability(const hdf5::Group& root, const study::Study& study,
                                        double confidence) {
  const DeviationSources& sources = stored_sources(root, study.features);
  const layout::TableIo axis = layout::TableIo::open(root, trial_axis_table(sources).table);
  const layout::TableIo targets = layout::TableIo::open(root, trial_target_table(sources).table);
  RepeatabilitySummary summary{confidence, shape_of(study.sequence), {}, study.units.axis, &sources};
  require_rows(axis, study::trial_count(study));
  require_rows(targets, study::trial_count(study));
  if (targets.width() != summary.shape.targets) targets.row_scale().fail("it has another number of targets");
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    const std::int64_t first = point * study.trials;
    summary.points.push_back(
        point_statistics({axis, first, study.trials}, {targets, first, study.trials}, summary, study));
    find_masses(study, point, summary.points.back());
  }
  return summary;
}

RepeatabilitySummary study_repeatability(const reading::AllTrialsFile& file, const study::Study& study,
                                         double confidence) {
  return read_repeatability(hdf5::File::open_to_read(file.path()), study, confidence);
}

}  // namespace zerocount::iso230
