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

/// Version of the layout. Files of any other version are refused.
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
  std::string name;       ///< Path below the table's group
  std::string unit;       ///< Unit; "1" if dimensionless
  std::string long_name;  ///< Description in one line
  hdf5::Element element{hdf5::Element::float64};
  std::vector<FlagMeaning> flags{};  ///< Values of an enumeration; otherwise empty
  std::string role{};  ///< Role of a column of /point: "axis" or "statistic"; empty in other tables
};

/// The label of `value` in an enumeration; the number as text if the enumeration has no such value.
std::string value_text(const Column& column, std::int64_t value);

/// The last dimension of the columns of a table, if its scale stands in the root.
struct RootDimension {
  Column scale;
  std::vector<double> values;  ///< Stored as the scale's element
};

/// A group of columns that share their first dimension, and the dimension scales that stand in it.
struct Table {
  std::string group;             ///< Path of the group from the root
  Column rows;                   ///< Dimension scale of the first dimension
  std::optional<Column> second;  ///< Dimension scale of the second dimension of all columns
  std::vector<Column> columns;
  std::optional<RootDimension> last{};  ///< Dimension after `rows` and `second`, of all columns
};

/// The values that a column can have. A file with any other is damaged.
struct ValidValues {
  std::string_view expected{};  ///< Possible values in words; empty if every value is possible
  double low{0.0};              ///< Lowest value
  double high{std::numeric_limits<double>::max()};
  bool nan{false};  ///< NaN is possible.
};

/// Source of a column's value: a member of the record, or a function of the record.
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
/// The measures of this program, including the measures of the error bands and tolerances of these features.
const MeasureTable& measure_table(const study::StudyFeatures& features = {});

/// Measures of one tolerance of a move.
struct ToleranceRecord {
  double settling_time{0.0};        ///< Entry of MoveOutcome::tolerance_settling_times
  double other_settling_time{0.0};  ///< Entry of MoveOutcome::other_tolerance_settling_times
};

/// A jerk, and the trial it belongs to.
struct JerkRecord : trial::Jerk {
  std::int64_t trial{0};  ///< Global row
};

/// A sampling instant of a retained trial.
struct TraceRecord : trial::SampleRecord {
  std::int64_t trial{0};  ///< Global row
};

/// The measures of a move that a file with these features has.
std::vector<RecordField<trial::MoveOutcome>> outcome_fields(const study::StudyFeatures& features = {},
                                                            const MeasureTable& measures = measure_table());
/// The measures of a move that are columns of outcome_table(): all except the measures of error bands and
/// tolerances.
std::vector<RecordField<trial::MoveOutcome>> move_fields(const study::StudyFeatures& features,
                                                         const MeasureTable& measures);
/// The columns of band_table().
const std::vector<RecordField<trial::BandOutcome>>& band_fields();
const std::vector<RecordField<JerkRecord>>& jerk_fields();
/// The columns of a sample record. The columns that `features` add come last.
std::vector<RecordField<TraceRecord>> trace_fields(const study::StudyFeatures& features);

/// The columns of tolerance_table() for one tolerance: the settling time and, if the features ask for it, the
/// settling time of the other mass.
std::vector<RecordField<ToleranceRecord>> tolerance_fields(const study::StudyFeatures& features);

/// "band_settling_time_p95[1]": the name of a number of an error band.
std::string name_of_band(std::string_view name, std::int64_t band);
/// "tolerance_settling_time_p95[1e-08]": the name of a number of a tolerance.
std::string name_of_tolerance(std::string_view name, double tolerance);

/// Whether the name is the name of a number of a tolerance, such as "load_tolerance_settling_time_p95". The
/// tolerance itself may be missing at its end.
inline bool is_of_tolerance(std::string_view name) {
  return name.find("tolerance_") != std::string_view::npos;
}

/// A column of statistics, made when a study is complete: one number per design point, or several where
/// stated (StatisticTable, GroupCounts). In files, columns whose names differ only in the error band or
/// tolerance at their end, as in "band_settling_time_p95[1]", are one dataset [point, band].
struct PointColumn {
  std::string name;
  std::string unit;
  std::string long_name;
  std::vector<double> values;  ///< [point]; NaN where there is none
};

/// A group of statistics that have a second dimension beside the design point.
struct StatisticGroup {
  std::string_view name;       ///< Name of the group in the root
  std::string_view dimension;  ///< Name of the second dimension, and of its scale
  std::string_view meaning;    ///< Meaning of an index of the second dimension, in one line
  std::string_view csv;        ///< Name of the CSV file to which the group is exported
};

/// All groups of statistics that a file may have.
std::span<const StatisticGroup> statistic_groups();
/// The statistics of the torque levels of an open-loop study.
const StatisticGroup& level_group();

/// The statistics of one group.
struct StatisticTable {
  const StatisticGroup* group{nullptr};  ///< Entry of statistic_groups()
  std::int64_t width{1};                 ///< Size of the second dimension
  std::vector<PointColumn> columns;      ///< Statistics, values[point·width + index]
};

/// Trials of the groups of a grouping at the design points, [point][group].
struct GroupCounts {
  std::vector<std::vector<std::int64_t>> trials;   ///< Trials that were judged; 0 in an open loop
  std::vector<std::vector<std::int64_t>> success;  ///< Trials whose moves all ended with a zero count
  /// Trials whose moves all meet the goal; empty without a goal
  std::vector<std::vector<std::int64_t>> goal_met{};
  std::vector<PointColumn> statistics{};  ///< Further statistics, values[point·groups + group]
};

/// All stored statistics of consecutive design points of a study.
struct StoredStatistics {
  std::vector<PointColumn> points;
  std::vector<StatisticTable> tables;                ///< Tables of statistics, at most one per group
  std::map<std::string_view, GroupCounts> groups{};  ///< Counts by the name of the grouping (groupings.hpp)
};

/// Number of angles over one revolution at which a profile is tabulated if all trials are on one rotor.
inline constexpr std::int64_t profile_angles = 4096;

/// Number of angles of a profile if every machine has a rotor of its own: the smallest power of two with
/// eight angles in the shortest wavelength of the field, from 64 to profile_angles. With many machines it is
/// halved until there are at most 2²² values, as long as two angles remain in that wavelength.
/// @param harmonics number of harmonics of the profile's series.
std::int64_t profile_angles_of_machine(std::size_t harmonics, std::int64_t machines);

/// The scale of the design points.
Column point_scale();
/// Columns that hold the values of parameters.
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
/// The table of outcomes that holds only the verdicts.
Table verdict_table();
Table jerk_table();
Table trace_table(const study::StudyFeatures& features);
Table statistic_table(const StatisticGroup& group, const std::vector<PointColumn>& columns);
Table profile_table(const std::string& name, const std::string& unit);
/// The rotors of all machines: [machine, theta].
Table rotor_table(const std::string& name, const std::string& unit);
/// Counts of the whole and real numbers in /sums that belong to each design point: [point].
Table sums_table();
/// The whole and the real numbers of /sums, point after point.
Table whole_sums_table();
Table real_sums_table();

/// The table with the units and long names that its columns have on an axis of this kind. The functions above
/// give them for a rotary axis. Values that a study defines itself (its sweep, inputs and profiles) have
/// their own units.
Table on_axis(Table table, parameters::AxisKind axis);
/// The column with its unit and long name on an axis of this kind.
PointColumn on_axis(PointColumn column, parameters::AxisKind axis);

/// Name in /trial and /machine of the column of an input parameter.
std::string input_column_name(const std::string& parameter);

}  // namespace zerocount::layout
