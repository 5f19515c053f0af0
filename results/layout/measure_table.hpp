#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/features.hpp"
#include "results/layout/layout.hpp"

/// The table of the measures of a move. A measure is one row: its column in the results file with the valid
/// values, its statistics at a point and at a torque level, its columns in the summary, its output in the
/// sensitivity analysis, and its judgement by the gate. core/trial computes its value. A measure of error
/// bands has one row for all bands, and a measure of tolerances one row for all tolerances.
namespace zerocount::layout {

/// Meaning of a value that a move lacks although it was run. A move that was stopped, or lost its motion,
/// lacks values for that reason instead: they are worse than every limit, for any measure.
enum class Missing {
  never,  ///< An event did not come, such as rest. The value is worse than every limit.
  late,   ///< The value is a time that did not come within the move, and is worse than every limit. Quantiles
          ///< include all moves and count it as later than any time.
  none    ///< There is nothing to measure, such as an oscillation. The move meets every limit.
};

enum class Worse { less, more };

/// Values of the moves that count, in statistics and in outputs of a trial.
struct CountedValues {
  bool needs_target{false};         ///< Undefined for moves to a torque level; a sum over them is 0.
  bool needs_motion{false};         ///< Undefined for moves whose motion was lost.
  Missing missing{Missing::never};  ///< Meaning of NaN.
  bool negative_is_missing{false};  ///< Negative values mean the same as NaN.
  Worse worse{Worse::more};  ///< Whether larger or smaller values are worse; this orders Missing::never.
  bool magnitude{false};     ///< Statistics are of the absolute value.
  bool mirrored{false};      ///< The sign is opposite in a move of the opposite direction.
};

/// Rule that reduces the values of the moves to one value of their trial.
enum class MoveReduction {
  all,      ///< For a quality: 1 if every move has it, otherwise 0.
  any,      ///< For a quality: 1 if some move has it, otherwise 0.
  sum,      ///< Sum over the moves.
  largest,  ///< Largest absolute value of the moves.
  last      ///< Value of the last move.
};

/// A statistic of the values at a point, in the order of every report. Names and meanings: statistic_kinds()
/// of analysis/measures.
enum class Statistic {
  count,  ///< Number of trials with the quality.
  rate,
  rate_low,
  rate_high,
  rate_wilson_low,
  rate_wilson_high,
  moves_rate,  ///< Moves with the quality, as a proportion of the moves.
  moves_rate_low,
  moves_rate_high,
  n,       ///< Number of values.
  all,     ///< Number of values, including times that count as later than any.
  trials,  ///< Number of trials, or values, above 0.
  mean,
  student_low,  ///< Lower bound of the mean; student_high is the upper bound.
  student_high,
  sd,
  rms,
  min,
  p05,
  p25,
  median,
  median_low,
  median_high,
  p75,
  p95,
  p95_low,
  p95_high,
  max,
  whole_max,  ///< Maximum as a whole number; 0 without values.
  total,
  bootstrap_low,  ///< Lower bound of the mean, which only summaries have; bootstrap_high is the upper bound.
  bootstrap_high
};

/// Statistics and their long name. In the long name {0} stands for the name of the statistic, such as "5 %
/// quantile" or "lower bound of the mean", and {1} for the bound alone, "lower bound".
struct StatisticText {
  std::vector<Statistic> statistics;
  std::string_view long_name;
  std::string_view name{};  ///< Name in place of the statistic's own name; empty: the statistic's own name
};

/// The statistics that are reported for a measure.
struct ReportedStatistics {
  std::string_view group{};  ///< Object of the JSON that holds the statistics; empty: they stand at the top
  std::vector<StatisticText> texts{};  ///< Statistics with their texts, in any order
  std::string_view stem{};             ///< Stem of the names at the top; empty: the measure's name
};

/// Format of the cells of a column. `percent` is a proportion. For `proportion_of_trials` and
/// `proportion_of_moves` the statistic is a count, which is divided by the number of trials or moves.
enum class CellText { number, settling_time, percent, proportion_of_trials, proportion_of_moves };

/// Bounds of a statistic, written behind it.
struct BoundStatistics {
  Statistic low;
  Statistic high;
};

struct SummaryColumn {
  std::string head;
  Statistic statistic;
  CellText text{CellText::number};
  std::optional<BoundStatistics> bounds{};
};

/// The columns of a measure in the summary's table.
struct SummaryColumns {
  /// Feature that a study must use to have the columns; null: none is needed
  bool study::StudyFeatures::*use{nullptr};
  std::vector<SummaryColumn> columns{};
  std::string legend{};  ///< Whole lines that explain the columns
};

/// A measure as an output of a trial that `sensitivity` explains.
struct ExplainedOutput {
  std::string name;
  std::string_view meaning;
};

/// A measure as the gate judges it: qualities by the proportion of trials that have them, sums by their mean
/// over trials, others by the mean over trials of the mean over the moves that have a value.
struct GatedMeasure {
  std::string name;
  Worse worse{Worse::more};
  double absolute{0.0};  ///< Default margin, in the measure's unit
  double relative{0.0};  ///< Default margin, as a proportion of the baseline's value
};

/// One measure of a move.
struct Measure {
  RecordField<trial::MoveOutcome> field;
  std::optional<std::int64_t> band{};  ///< Limit of the error band that the measure belongs to, counts
  std::optional<double> tolerance{};   ///< Tolerance of the position error that the measure belongs to, rad
  bool study::StudyFeatures::*only_with{nullptr};  ///< Feature without which no file has the measure.
  CountedValues values{};
  MoveReduction reduction{MoveReduction::last};
  ReportedStatistics point{};  ///< Statistics at a design point.
  ReportedStatistics level{};  ///< Statistics at a torque level of an open-loop study.
  SummaryColumns summary{};
  std::optional<ExplainedOutput> output{};
  std::optional<GatedMeasure> gate{};
};

/// Whether a file with these features has the measure.
bool is_in_file(const Measure& measure, const study::StudyFeatures& features);

/// Whether the moves have, or lack, the measure as a quality.
bool is_quality(const Measure& measure);
bool has_quality(const Measure& measure, const trial::MoveOutcome& move);
/// Writes 1 for each move that has the quality, 0 for the others.
void qualities_of(const Measure& measure, std::span<const trial::MoveOutcome* const> moves,
                  std::span<double> qualities);

/// Orders of the measures in reports. They are those of earlier versions: measures with a fixed place come
/// first, the others follow in the order of the table.
enum class ReportOrder { statistics, levels, summary, outputs };

/// The measures of the table that `belongs` picks, in the order of the report. They point into the table.
std::vector<const Measure*> measures_of(const MeasureTable& measures, ReportOrder order,
                                        bool (*belongs)(const Measure&));

/// The measures of a move that do not depend on the study, in the order of the file.
MeasureTable move_measures();

/// The measures of error band number `slot`, in the order of band_fields().
std::vector<Measure> measures_of_band(const trial::ErrorBands& bands, std::size_t slot);

/// The settling time of the tolerance number `slot`.
std::vector<Measure> measures_of_tolerance(const trial::Tolerances& tolerances, std::size_t slot);

}  // namespace zerocount::layout
