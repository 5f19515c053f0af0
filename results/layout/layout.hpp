#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/features.hpp"
#include "experiments/study/grouping.hpp"
#include "results/hdf5/element.hpp"
#include "results/hdf5/hdf5.hpp"

/// The layout of results files: the one description from which the writer, the reader, the CSV export and the
/// test of the format's documentation (results/datasets.md) all derive.
namespace zerocount::layout {

/// A contiguous block of trials by global row: row = point·trials + index, so that the trials of a point are
/// neighbours.
struct RowRange {
  std::int64_t first{0};
  std::int64_t count{0};

  std::int64_t end() const { return first + count; }
  bool operator==(const RowRange&) const = default;
};

/// Number of rows of all `ranges`.
inline std::int64_t total_rows(std::span<const RowRange> ranges) {
  std::int64_t rows = 0;
  for (const RowRange& range : ranges) rows += range.count;
  return rows;
}

/// Version of the layout: files of any other are refused.
inline constexpr std::int64_t format_version = 5;

/// One value of an enumeration, and its word in `flag_meanings` and in CSV.
struct FlagMeaning {
  std::int64_t value{0};
  std::string word;
};

/// The outcomes of a move.
std::vector<FlagMeaning> outcome_labels();

/// One dataset of a table.
struct Column {
  std::string name;       ///< path below the table's group
  std::string unit;       ///< "1" where dimensionless
  std::string long_name;  ///< one line
  hdf5::Element element{hdf5::Element::float64};
  std::vector<FlagMeaning> flags{};  ///< of an enumeration, otherwise empty
  std::string role{};                ///< in /point only: "axis" or "statistic"
};

/// The label of `value` in an enumeration; the number as text if the enumeration has no such value.
std::string value_text(const Column& column, std::int64_t value);

/// The last dimension of the columns of a table, if its scale stands in the root.
struct RootDimension {
  Column scale;
  std::vector<double> values;  ///< stored as the scale's element
};

/// A group of columns that share their first dimension, and the dimension scales that stand in it.
struct Table {
  std::string group;             ///< path from the root
  Column rows;                   ///< dimension scale of the first dimension
  std::optional<Column> second;  ///< dimension scale of the second dimension, of all columns
  std::vector<Column> columns;
  std::optional<RootDimension> last{};  ///< dimension after `rows` and `second`, of all columns
};

/// The values that a column can have. A file with any other is damaged.
struct ValidValues {
  std::string_view expected{};  ///< in words; empty where every value is possible
  double low{0.0};              ///< lowest
  double high{std::numeric_limits<double>::max()};
  bool nan{false};  ///< NaN is possible
};

/// Where a column's value stands in a record, or the function that computes it.
template <class Record>
using Member = std::variant<double Record::*, std::int64_t Record::*, int Record::*, bool Record::*,
                            trial::Outcome Record::*, trial::HookMode Record::*, loop::ControlPhase Record::*,
                            double (*)(const Record&)>;

template <class Record>
struct RecordField {
  Column column;
  Member<Record> member;
  ValidValues valid{};
};

struct Measure;
/// The measures of a move, in the order of the file (see measure_table.hpp).
using MeasureTable = std::vector<Measure>;
/// The measures of this program, with those of the error bands and tolerances of these features.
const MeasureTable& measure_table(const study::StudyFeatures& features = {});

/// What is measured of one tolerance of a move.
struct ToleranceRecord {
  double settling_time{0.0};        ///< MoveOutcome::tolerance_settling_times
  double other_settling_time{0.0};  ///< MoveOutcome::other_tolerance_settling_times
};

/// A jerk, and the trial it belongs to.
struct JerkRecord : trial::Jerk {
  std::int64_t trial{0};  ///< global row
};

/// A sampling instant of a retained trial.
struct TraceRecord : trial::SampleRecord {
  std::int64_t trial{0};  ///< global row
};

/// The measures of a move that a file with these features has.
std::vector<RecordField<trial::MoveOutcome>> outcome_fields(const study::StudyFeatures& features = {},
                                                            const MeasureTable& measures = measure_table());
/// Those of them that are columns of outcome_table(): all but the measures of error bands and tolerances.
std::vector<RecordField<trial::MoveOutcome>> move_fields(const study::StudyFeatures& features,
                                                         const MeasureTable& measures);
/// The columns of band_table().
const std::vector<RecordField<trial::BandOutcome>>& band_fields();
const std::vector<RecordField<JerkRecord>>& jerk_fields();
/// The columns of a sample record; those of `features` come last.
std::vector<RecordField<TraceRecord>> trace_fields(const study::StudyFeatures& features);

/// The columns of tolerance_table(): of one tolerance, and of both masses if the features have the other one.
std::vector<RecordField<ToleranceRecord>> tolerance_fields(const study::StudyFeatures& features);

/// "band_settling_time_p95[1]": the name of a number of an error band.
std::string name_of_band(std::string_view name, std::int64_t band);
/// "tolerance_settling_time_p95[1e-08]": the name of a number of a tolerance.
std::string name_of_tolerance(std::string_view name, double tolerance);

/// Whether it is a number of a tolerance, with or without that: "load_tolerance_settling_time_p95".
inline bool is_of_tolerance(std::string_view name) {
  return name.find("tolerance_") != std::string_view::npos;
}

/// One number per design point, made when a study is complete. In files, columns whose names differ only in
/// the error band at their end, as in "band_settling_time_p95[1]", are one dataset [point, band].
struct PointColumn {
  std::string name;
  std::string unit;
  std::string long_name;
  std::vector<double> values;  ///< [point]; NaN where there is none
};

/// A group of statistics that have a second dimension beside the design point.
struct StatisticGroup {
  std::string_view name;       ///< of the group in the root
  std::string_view dimension;  ///< name of the second dimension, and of its scale
  std::string_view meaning;    ///< one line: what an index of the second dimension is
  std::string_view csv;        ///< file that the group is exported to
};

/// All such groups that a file may have.
std::span<const StatisticGroup> statistic_groups();
/// The statistics of the torque levels of an open-loop study.
const StatisticGroup& level_group();

/// The statistics of one group.
struct StatisticTable {
  const StatisticGroup* group{nullptr};  ///< of statistic_groups()
  std::int64_t width{1};                 ///< size of the second dimension
  std::vector<PointColumn> columns;      ///< values[point·width + index]
};

/// Trials of the groups of a grouping at the design points, [point][group].
struct GroupCounts {
  std::vector<std::vector<std::int64_t>> trials;      ///< that were judged: none in an open loop
  std::vector<std::vector<std::int64_t>> success;     ///< all of whose moves ended with a zero count
  std::vector<std::vector<std::int64_t>> goal_met{};  ///< all of whose moves meet the goal; empty without one
  std::vector<PointColumn> statistics{};              ///< further ones: values[point·groups + group]
};

/// Everything that is stored of the statistics of consecutive design points of a study: of all of them, or of
/// the first ones.
struct StoredStatistics {
  std::vector<PointColumn> points;
  std::vector<StatisticTable> tables;                ///< none twice
  std::map<std::string_view, GroupCounts> groups{};  ///< by the name of the grouping (see groupings.hpp)
};

/// Number of angles at which a profile is tabulated, over one revolution, where all trials are on one rotor.
inline constexpr std::int64_t profile_angles = 4096;

/// Number of angles of a profile where every machine has a rotor: the smallest power of two with eight angles
/// in the shortest wavelength of the field, from 64 to profile_angles. With many machines it is halved until
/// there are at most 2²² values, as long as two angles remain in that wavelength.
/// @param harmonics of the profile's series.
std::int64_t profile_angles_of_machine(std::size_t harmonics, std::int64_t machines);

/// The scale of the design points.
Column point_scale();
/// Columns of the values of parameters.
std::vector<Column> input_columns(const std::vector<study::InputColumn>& inputs);
Table point_table(const std::vector<study::SweepAxis>& axes, const std::vector<PointColumn>& statistics);
Column statistic_column(const PointColumn& statistic);
/// Statistics of the design points for each error band, or tolerance: [point, band]. It has no columns yet.
Table limit_statistic_table(RootDimension limits);
Table trial_table(const std::vector<study::InputColumn>& inputs);
Table outcome_table(const study::StudyFeatures& features = {},
                    const MeasureTable& measures = measure_table());
/// The measures of error bands: [trial, move, band].
Table band_table(const trial::ErrorBands& bands);
/// The dimension of error bands, with its scale.
RootDimension band_dimension(const trial::ErrorBands& bands);
/// The measures of tolerances: [trial, move, tolerance].
Table tolerance_table(const study::StudyFeatures& features);
/// The dimension of tolerances, with its scale.
RootDimension tolerance_dimension(const trial::Tolerances& tolerances);
/// The table of outcomes with the verdicts alone.
Table verdict_table();
Table jerk_table();
Table trace_table(const study::StudyFeatures& features);
Table statistic_table(const StatisticGroup& group, const std::vector<PointColumn>& columns);
Table profile_table(const std::string& name, const std::string& unit);
/// The rotors of all machines: [machine, theta].
Table rotor_table(const std::string& name, const std::string& unit);
/// How many of the whole and real numbers in /sums belong to each design point: [point].
Table sums_table();
/// The numbers themselves, point after point.
Table whole_sums_table();
Table real_sums_table();

/// The table with the units and long names that its columns have on an axis of this kind. The tables above
/// have those of a rotary axis. What a study defines itself (its sweep, inputs and profile values) has its
/// own units.
Table on_axis(Table table, parameters::AxisKind axis);
/// The column with its unit and long name on an axis of this kind.
PointColumn on_axis(PointColumn column, parameters::AxisKind axis);

/// Name in /trial and /machine of the column of an input parameter.
std::string input_column_name(const std::string& parameter);

}  // namespace zerocount::layout
