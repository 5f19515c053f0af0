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

/// The table of the measures of a move. Each row describes one measure: its column in the results file with
/// the valid values, its statistics at a design point and at a torque level, its columns in the summary, its
/// output in the sensitivity analysis, and its judgement by the gate of the command `compare`. The values are
/// computed in core/trial. A measure of error bands has one row for all bands, and a measure of tolerances
/// one row for all tolerances.
namespace zerocount::layout {

/// Meaning of a missing (NaN) value of a measure in a move that was run. A move that was stopped or lost its
/// motion lacks values for that reason instead: they count as worse than every limit, for any measure.
enum class Missing {
  never,  ///< An event did not come, such as rest. The value is worse than every limit.
  late,   ///< The value is a time that did not come within the move, and is worse than every limit. Quantiles
          ///< include all moves and count it as later than any time.
  none    ///< There is nothing to measure, such as an oscillation. The move meets every limit.
};

enum class Worse { less, more };

/// Rule by which the values of a measure count in statistics and in outputs of a trial: which moves count,
/// and how.
struct CountedValues {
  bool needs_target{false};         ///< Moves to a torque level have no value of the measure; a sum over them
                                    ///< is 0.
  bool needs_motion{false};         ///< Moves whose motion was lost have no value of the measure.
  Missing missing{Missing::never};  ///< Meaning of NaN in a move that was run.
  bool negative_is_missing{false};  ///< Negative values of the measure mean the same as NaN, a missing value.
  Worse worse{Worse::more};  ///< Whether larger or smaller values are worse; it also decides what a value
                             ///< with Missing::never counts as.
  bool magnitude{false};     ///< Statistics are computed from the absolute values.
  bool mirrored{false};      ///< The sign of the measure is reversed in a move of the opposite direction.
};

/// Rule that reduces the values of a measure in the moves of a trial to one value of the trial. A quality is
/// a measure that is true or false.
enum class MoveReduction {
  all,      ///< For a quality: 1 if every move has it, otherwise 0.
  any,      ///< For a quality: 1 if some move has it, otherwise 0.
  sum,      ///< Sum of the values of the moves.
  largest,  ///< Largest absolute value of the measure in the moves.
  last      ///< Value of the measure in the last move.
};

/// A statistic of the values of a measure at a design point, in the order of every report. A quality is a
/// measure that is true or false. Names and meanings: statistic_kinds() of analysis/trials/measures.
enum class Statistic {
  count,  ///< Number of trials that have the quality.
  rate,
  rate_low,
  rate_high,
  rate_wilson_low,
  rate_wilson_high,
  moves_rate,  ///< Number of moves with the quality, as a proportion of all moves.
  moves_rate_low,
  moves_rate_high,
  n,       ///< Number of values that are not missing.
  all,     ///< Number of values, including missing times, which count as later than any other.
  trials,  ///< Number of trials, or of values, that are above 0.
  mean,
  student_low,  ///< Lower confidence bound of the mean; student_high is the upper one.
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
  whole_max,  ///< Largest value, as a whole number; 0 without values.
  total,
  bootstrap_low,  ///< Lower bootstrap confidence bound of the mean, which only summaries have; bootstrap_high
                  ///< is the upper one.
  bootstrap_high
};

/// Statistics of a measure that share one long name. In the long name {0} stands for the name of the
/// statistic, such as "5 % quantile" or "lower bound of the mean", and {1} for the bound alone, "lower
/// bound".
struct StatisticText {
  std::vector<Statistic> statistics;
  std::string_view long_name;
  std::string_view name{};  ///< Name of the statistic in files and JSON; empty: the statistic's own name
};

/// The statistics of a measure that are reported, and their names.
struct ReportedStatistics {
  std::string_view group{};  ///< JSON object that holds the statistics; empty: they stand at the top level of
                             ///< the JSON
  std::vector<StatisticText> texts{};  ///< Statistics with their long names, in any order
  std::string_view stem{};             ///< Beginning of the names of statistics at the top level; empty: the
                                       ///< measure's name
};

/// Format of the cells of a column in the summary. `percent` shows a proportion. For `proportion_of_trials`
/// and `proportion_of_moves` the statistic is a count, which is divided by the number of trials or moves.
enum class CellText { number, settling_time, percent, proportion_of_trials, proportion_of_moves };

/// Confidence bounds of a statistic, which the summary prints after the statistic.
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

/// The columns that a measure has in the table of the command `summary`.
struct SummaryColumns {
  /// Feature that a study must use for its summary to have these columns; null: none is needed
  bool study::StudyFeatures::*use{nullptr};
  std::vector<SummaryColumn> columns{};
  std::string legend{};  ///< Complete lines below the table that explain the columns
};

/// A measure as an output of a trial whose dependence on the inputs the command `sensitivity` explains.
struct ExplainedOutput {
  std::string name;
  std::string_view meaning;
};

/// A measure as the gate of the command `compare` compares it with a baseline. Qualities (true or false) are
/// judged by the proportion of trials that have them, sums by their mean over trials, others by the mean over
/// trials of the mean over the moves that have a value.
struct GatedMeasure {
  std::string name;
  Worse worse{Worse::more};
  double absolute{0.0};  ///< Default margin by which the measure may be worse than the baseline, in the
                         ///< measure's unit
  double relative{0.0};  ///< Default margin by which the measure may be worse, as a proportion of the
                         ///< baseline's value
};

/// Description of one measure of a move, such as its arrival time: column, statistics, and use in reports.
struct Measure {
  RecordField<trial::MoveOutcome> field;
  std::optional<std::int64_t> band{};  ///< Half width of the error band to which the measure belongs, counts;
                                       ///< empty for other measures
  std::optional<double> tolerance{};   ///< Tolerance of the position error to which the measure belongs, rad;
                                       ///< empty for other measures
  bool study::StudyFeatures::*only_with{nullptr};  ///< Feature that a study must use for its files to have
                                                   ///< the measure; null: none is needed
  CountedValues values{};
  MoveReduction reduction{MoveReduction::last};
  ReportedStatistics point{};  ///< Statistics that are reported for a design point
  ReportedStatistics level{};  ///< Statistics that are reported for a torque level of an open-loop study
  SummaryColumns summary{};
  std::optional<ExplainedOutput> output{};
  std::optional<GatedMeasure> gate{};
};

/// Whether the files of a study with these features have the measure.
bool is_in_file(const Measure& measure, const study::StudyFeatures& features);

/// Whether the measure is a quality, which a move has or lacks (true or false), not a number.
bool is_quality(const Measure& measure);
bool has_quality(const Measure& measure, const trial::MoveOutcome& move);
/// Writes to `qualities`, [move], 1 for each move that has the quality `measure` and 0 for the others.
void qualities_of(const Measure& measure, std::span<const trial::MoveOutcome* const> moves,
                  std::span<double> qualities);

/// Reports that list the measures of a move, each in an order of its own. The orders are those of earlier
/// versions: measures with a fixed place come first, the others follow in the order of the table.
enum class ReportOrder { statistics, levels, summary, outputs };

/// The measures of the table for which `belongs` is true, in the order of the report. The pointers point into
/// the table.
std::vector<const Measure*> measures_of(const MeasureTable& measures, ReportOrder order,
                                        bool (*belongs)(const Measure&));

/// Descriptions of the measures of a move that do not depend on the study, in the order of the file.
MeasureTable move_measures();

/// Descriptions of the measures of the error band with the index `slot` in `bands`, in the order of
/// band_fields().
std::vector<Measure> measures_of_band(const trial::ErrorBands& bands, std::size_t slot);

/// Descriptions of the settling times for the tolerance with the index `slot` in `tolerances`.
std::vector<Measure> measures_of_tolerance(const trial::Tolerances& tolerances, std::size_t slot);

}  // namespace zerocount::layout
