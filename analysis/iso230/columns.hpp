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

/// How a value is distributed over the trials of a design point for which it is defined: n, mean, max, median
/// and p95 with order-statistic bounds.
using ValueStatistics = measures::MeasureStatistics;

/// @param values in any order; NaN is left out
ValueStatistics statistics_of(std::vector<double> values, double confidence = statistics::summary_confidence);

/// One number of ValueStatistics as it is reported, under "<value>_<name>" where there are no groups.
struct ValueStatisticField {
  std::string_view name;
  std::string long_name;  ///< begins that of the number
  bool of_targets;        ///< reported of the values of a target, too
  double (*value)(const ValueStatistics&);
};

const std::vector<ValueStatisticField>& value_statistic_fields();

/// The values of ISO 230-2 over the trials of a point, from one kind of deviation.
struct SourceRepeatability {
  std::vector<ValueStatistics> axis;                  ///< [axis_fields()]
  std::vector<std::vector<ValueStatistics>> targets;  ///< [target][target_fields()]
};

/// The statistics of a design point of a study with a sequence of moves.
struct PointRepeatability {
  std::int64_t trials{0};
  std::int64_t evaluated{0};  ///< trials whose motion was never lost: those that have values
  /// Trials in which, by the encoder, all approaches of a target ended on the same count: R = 0, or R↑ or R↓
  /// where there is one direction only. Nothing of a single cycle, which has no repeatability.
  std::optional<std::int64_t> zero_repeatability{};
  double zero_rate{statistics::unknown};                 ///< zero_repeatability / trials; NaN for n = 1
  statistics::ConfidenceInterval zero_bounds{0.0, 1.0};  ///< of zero_rate; with machines Korn–Graubard
  std::vector<statistics::Moments> positions;            ///< [target], counts
  std::vector<SourceRepeatability> sources;              ///< [source]
  bool has_load{false};                                  ///< There is a second mass in some trial.
  /// Mass whose encoder closes the loop. Nothing on an axis with one mass, or where trials of the point
  /// differ.
  std::optional<motion::EncoderPlace> closing{};
};

/// The numbers of a point that are neither of the axis nor of a target.
const std::vector<text::ReportField<PointRepeatability>>& point_repeatability_fields();

/// The scale by which the deviations are measured.
struct DeviationSource {
  std::string name;       ///< "true", "encoder", "load_true" or "motor_true"
  std::string unit;       ///< Unit of the deviations, and of all values made of them.
  std::string long_name;  ///< ends the long_name of a value
  Repeatability TrialRepeatability::*values;
  /// Mass other than the one that closes the loop. Nothing: the source is of the one that does.
  std::optional<motion::EncoderPlace> other{};
};
using DeviationSources = std::vector<DeviationSource>;

/// The true position, then the encoder; with a second mass then the true position of each mass that does not
/// close the loop somewhere.
const DeviationSources& deviation_sources(const study::StudyFeatures& features);

/// The repeatability part of the summary of a study with a sequence.
struct RepeatabilitySummary {
  double confidence{statistics::summary_confidence};  ///< of all bounds
  SequenceShape shape;
  std::vector<PointRepeatability> points;                   ///< [point]
  parameters::AxisKind axis{parameters::AxisKind::rotary};  ///< whose units the deviations have
  const DeviationSources* sources{&deviation_sources({})};  ///< Sources that the points have values of.
};

/// A table of the group /repeatability of a results file. The columns of values are named "<source>/<value>",
/// for every source in order, and axis_fields() or target_fields(); those of points
/// "<source>/<value>_<statistic>", in the order of value_statistic_fields(). The file, the CSV summary and
/// the export have them from here.
template <typename Row>
struct RepeatabilityTable {
  using ValueOf = std::function<double(const Row&, std::size_t)>;
  layout::Table table;
  std::vector<ValueOf> values{};  ///< [column] of a row and target; target 0 where there is none

  void add(layout::Column column, ValueOf value) {
    table.columns.push_back(std::move(column));
    values.push_back(std::move(value));
  }
};

/// A trial as a row of the tables of trials.
struct SequenceTrial {
  std::vector<double> positions;             ///< [target], counts
  std::optional<TrialRepeatability> values;  ///< none where a move is nonfinite
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
  std::string_view symbol;  ///< of the standard
  std::string_view long_name;
  double Values::*value;
};

std::span<const RepeatabilityField<AxisRepeatability>> axis_fields();
std::span<const RepeatabilityField<TargetRepeatability>> target_fields();

}  // namespace zerocount::iso230
