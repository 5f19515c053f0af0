#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/sums/moments.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/report_field.hpp"
#include "analysis/trials/iso230/repeatability.hpp"
#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "core/motion/parameters.hpp"
#include "experiments/study/features.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::iso230 {

/// Distribution of a value over the trials of a design point for which it is defined: n, mean, max, median
/// and p95 with order-statistic bounds.
using ValueStatistics = measures::MeasureStatistics;

/// Statistics of the values of an ISO 230-2 quantity.
/// @param values in any order; NaN is left out
/// @param confidence confidence of the bounds
ValueStatistics statistics_of(std::vector<double> values, double confidence = statistics::summary_confidence);

/// One reported number of ValueStatistics, such as the median. In formats without groups its name is
/// "<value>_<name>".
struct ValueStatisticField {
  std::string_view name;
  std::string long_name;  ///< Beginning of the number's long name; the long name of the quantity follows.
  /// True if the number is reported for the quantities of single targets, too, not only for those of the
  /// axis.
  bool of_targets;
  double (*value)(const ValueStatistics&);
};

const std::vector<ValueStatisticField>& value_statistic_fields();

/// Statistics of the quantities of ISO 230-2 over the trials of a design point, computed from one kind of
/// deviation (DeviationSource).
struct SourceRepeatability {
  std::vector<ValueStatistics> axis;  ///< [field of axis_fields()] Statistics of the quantities of the axis.
  /// [target][field of target_fields()] Statistics of the quantities of each target.
  std::vector<std::vector<ValueStatistics>> targets;
};

/// The statistics of ISO 230-2 for a design point of a study with a sequence of moves.
struct PointRepeatability {
  std::int64_t trials{0};
  /// Number of trials that have ISO 230-2 quantities: those whose motion never became non-finite.
  std::int64_t evaluated{0};
  /// Number of trials with repeatability 0: by the encoder, all approaches of a target ended on the same
  /// count (R = 0; with approaches from one side only R↑ = 0 or R↓ = 0). Null for a single cycle, which has
  /// no repeatability.
  std::optional<std::int64_t> zero_repeatability{};
  /// Proportion of trials with repeatability 0: zero_repeatability / trials; NaN for a single cycle.
  double zero_rate{statistics::unknown};
  /// Bounds of zero_rate; if the study has machines, those of Korn and Graubard for dependent trials.
  statistics::ConfidenceInterval zero_bounds{0.0, 1.0};
  /// [target] Moments over the trials of the target position, counts.
  std::vector<statistics::Moments> positions;
  /// [source] Statistics computed from each kind of deviation, in the order of deviation_sources().
  std::vector<SourceRepeatability> sources;
  bool has_load{false};  ///< True if the axis has a second mass in at least one trial.
  /// Mass whose encoder closes the loop. Null on an axis with one mass, or if it differs between trials of
  /// the point.
  std::optional<motion::EncoderPlace> closing{};
};

/// The reported numbers of a design point that belong neither to the axis nor to a target, such as the number
/// of evaluated trials.
const std::vector<text::ReportField<PointRepeatability>>& point_repeatability_fields();

/// Kind of deviation from which the quantities of ISO 230-2 are computed: of a true position, or of the
/// encoder's count.
struct DeviationSource {
  /// Name of the position whose deviations are used. "true": true position, "encoder": count of the fine
  /// encoder; with two masses, both are those of the mass whose encoder closes the loop. "load_true",
  /// "motor_true": the true position of the other mass.
  std::string name;
  std::string unit;       ///< Unit of the deviations, and of all quantities computed from them.
  std::string long_name;  ///< End of the long name of a quantity, which names the kind of deviation.
  Repeatability TrialRepeatability::*values;
  /// Mass to which the deviations belong if it is not the one whose encoder closes the loop; otherwise null.
  std::optional<motion::EncoderPlace> other{};
};
using DeviationSources = std::vector<DeviationSource>;

/// The kinds of deviation of a study: of the true position, then of the encoder. With a second mass they are
/// followed by the true position of each mass that does not close the loop in some trial.
const DeviationSources& deviation_sources(const study::StudyFeatures& features);

/// The accuracy and repeatability (ISO 230-2) in the summary of a study with a sequence of moves.
struct RepeatabilitySummary {
  double confidence{statistics::summary_confidence};  ///< Confidence of all bounds.
  SequenceShape shape;
  std::vector<PointRepeatability> points;  ///< [point] Statistics of the design point.
  /// Kind of the axis, which sets the units of the deviations.
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  /// Kinds of deviation for which the points have statistics.
  const DeviationSources* sources{&deviation_sources({})};
};

/// A table of the group /repeatability of a results file. Columns of quantities are named "<source>/<value>",
/// for every kind of deviation in order and every one of axis_fields() or target_fields(). In tables of
/// points they are named "<source>/<value>_<statistic>", in the order of value_statistic_fields(). The file,
/// the CSV summary and the export all use these tables.
template <typename Row>
struct RepeatabilityTable {
  using ValueOf = std::function<double(const Row&, std::size_t)>;
  layout::Table table;
  /// [column] Function that returns the value for a row and a target; the target is 0 if the table has none.
  std::vector<ValueOf> values{};

  void add(layout::Column column, ValueOf value) {
    table.columns.push_back(std::move(column));
    values.push_back(std::move(value));
  }
};

/// Data of one trial, which is one row of the tables of trials.
struct SequenceTrial {
  std::vector<double> positions;  ///< [target] Target position, counts.
  /// ISO 230-2 quantities of the trial; null if the motion became non-finite in a move.
  std::optional<TrialRepeatability> values;
};

/// The table /repeatability/trial of a results file, [trial]: `evaluated`, then the quantities of the axis.
RepeatabilityTable<SequenceTrial> trial_axis_table(const DeviationSources& sources);
/// The table /repeatability/trial_target of a results file, [trial, target]: `position`, then the quantities
/// of the targets.
RepeatabilityTable<SequenceTrial> trial_target_table(const DeviationSources& sources);
/// The table /repeatability/point of a results file, [point]: point_repeatability_fields(), then the
/// statistics of the axis.
RepeatabilityTable<PointRepeatability> point_axis_table(const DeviationSources& sources);
/// The table /repeatability/point_target of a results file, [point, target]: `position_min`, `position_max`,
/// then the statistics of the targets.
RepeatabilityTable<PointRepeatability> point_target_table(const DeviationSources& sources);

template <typename Values>
struct RepeatabilityField {
  std::string_view name;
  std::string_view symbol;  ///< Symbol of the quantity in ISO 230-2, such as "R".
  std::string_view long_name;
  double Values::*value;
};

std::span<const RepeatabilityField<AxisRepeatability>> axis_fields();
std::span<const RepeatabilityField<TargetRepeatability>> target_fields();

}  // namespace zerocount::iso230
