#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/iso230/repeatability.hpp"
#include "analysis/measures/measure_statistics.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/sums/moments.hpp"
#include "analysis/statistics/unknown.hpp"
#include "analysis/text/report_field.hpp"
#include "core/motion/parameters.hpp"
#include "experiments/study/features.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::iso230 {

/// Distribution of a value over the trials of a design point for which it is defined: n, mean, max, median
/// and p95 with order-statistic bounds.
using ValueStatistics = measures::MeasureStatistics;

/// @param values in any order; NaN is left out
ValueStatistics statistics_of(std::vector<double> values, double confidence = statistics::summary_confidence);

/// One reported number of ValueStatistics. In formats without groups its name is "<value>_<name>".
struct ValueStatisticField {
  std::string_view name;
  std::string long_name;  ///< Beginning of the number's long name.
  bool of_targets;        ///< True if the number is also reported for the values of a target.
  double (*value)(const ValueStatistics&);
};

const std::vector<ValueStatisticField>& value_statistic_fields();

/// The values of ISO 230-2 over the trials of a point, from one kind of deviation.
struct SourceRepeatability {
  std::vector<ValueStatistics> axis;  ///< [axis_fields()] Statistics of the values of the axis.
  /// [target][target_fields()] Statistics of the values of the targets.
  std::vector<std::vector<ValueStatistics>> targets;
};

/// The statistics of a design point of a study with a sequence of moves.
struct PointRepeatability {
  std::int64_t trials{0};
  /// Number of trials that have values: those whose motion never became non-finite.
  std::int64_t evaluated{0};
  /// Number of trials in which, by the encoder, all approaches of a target ended on the same count: R = 0;
  /// with one direction only R↑ = 0 or R↓ = 0. Nothing for a single cycle, which has no repeatability.
  std::optional<std::int64_t> zero_repeatability{};
  double zero_rate{statistics::unknown};  ///< zero_repeatability / trials; NaN for n = 1
  /// Bounds of zero_rate; with machines after Korn and Graubard.
  statistics::ConfidenceInterval zero_bounds{0.0, 1.0};
  std::vector<statistics::Moments> positions;  ///< [target] Moments of the target positions, counts.
  std::vector<SourceRepeatability> sources;    ///< [source] Statistics from this kind of deviation.
  bool has_load{false};                        ///< True if there is a second mass in some trial.
  /// Mass whose encoder closes the loop. Nothing on an axis with one mass, or where trials of the point
  /// differ.
  std::optional<motion::EncoderPlace> closing{};
};

/// The reported numbers of a point that belong to neither the axis nor a target.
const std::vector<text::ReportField<PointRepeatability>>& point_repeatability_fields();

/// The scale by which the deviations are measured.
struct DeviationSource {
  /// Name of the position whose deviations are meant. "true", "encoder": the true position and the count of
  /// the fine encoder; with two masses, those of the mass whose encoder closes the loop. "load_true",
  /// "motor_true": the true position of the other mass.
  std::string name;
  std::string unit;       ///< Unit of the deviations, and of all values computed from them.
  std::string long_name;  ///< End of the long name of a value.
  Repeatability TrialRepeatability::*values;
  /// Mass to which the deviations belong if it is not the one that closes the loop. Nothing for the mass that
  /// closes the loop.
  std::optional<motion::EncoderPlace> other{};
};
using DeviationSources = std::vector<DeviationSource>;

/// The sources of a study: the true position, then the encoder. With a second mass they are followed by the
/// true position of each mass that does not close the loop in some trial.
const DeviationSources& deviation_sources(const study::StudyFeatures& features);

/// The repeatability part of the summary of a study with a sequence.
struct RepeatabilitySummary {
  double confidence{statistics::summary_confidence};  ///< Confidence of all bounds.
  SequenceShape shape;
  std::vector<PointRepeatability> points;  ///< [point] Statistics of the design point.
  /// Kind of the axis, which sets the units of the deviations.
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  /// Sources for which the points have values.
  const DeviationSources* sources{&deviation_sources({})};
};

/// A table of the group /repeatability of a results file. Columns of values are named "<source>/<value>", for
/// every source in order and every one of axis_fields() or target_fields(). In tables of points they are
/// named "<source>/<value>_<statistic>", in the order of value_statistic_fields(). The file, the CSV summary
/// and the export all use these tables.
template <typename Row>
struct RepeatabilityTable {
  using ValueOf = std::function<double(const Row&, std::size_t)>;
  layout::Table table;
  /// [column] Value for a row and a target; the target is 0 if the table has none.
  std::vector<ValueOf> values{};

  void add(layout::Column column, ValueOf value) {
    table.columns.push_back(std::move(column));
    values.push_back(std::move(value));
  }
};

/// A trial as a row of the tables of trials.
struct SequenceTrial {
  std::vector<double> positions;             ///< [target] Target position, counts.
  std::optional<TrialRepeatability> values;  ///< Values of the trial; none if a move became non-finite.
};

/// /repeatability/trial: `evaluated`, then the values of the axis, [trial].
RepeatabilityTable<SequenceTrial> trial_axis_table(const DeviationSources& sources);
/// /repeatability/trial_target: `position`, then the values of the targets, [trial, target].
RepeatabilityTable<SequenceTrial> trial_target_table(const DeviationSources& sources);
/// /repeatability/point: point_repeatability_fields(), then the statistics of the axis, [point].
RepeatabilityTable<PointRepeatability> point_axis_table(const DeviationSources& sources);
/// /repeatability/point_target: `position_min`, `position_max`, then the statistics of the targets, [point,
/// target].
RepeatabilityTable<PointRepeatability> point_target_table(const DeviationSources& sources);

template <typename Values>
struct RepeatabilityField {
  std::string_view name;
  std::string_view symbol;  ///< Symbol in the standard.
  std::string_view long_name;
  double Values::*value;
};

std::span<const RepeatabilityField<AxisRepeatability>> axis_fields();
std::span<const RepeatabilityField<TargetRepeatability>> target_fields();

}  // namespace zerocount::iso230
