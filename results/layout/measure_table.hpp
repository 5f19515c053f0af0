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
/// sensitivity analysis, and its judgement by the gate. What computes its value is in core/trial; measures of
/// error bands, and of tolerances, have one row for all of them.
namespace zerocount::layout {

/// Meaning of a value that a move lacks although it was run. A move that was stopped, or lost its motion,
/// lacks values for that reason instead: they are worse than every limit, for any measure.
enum class Missing {
  never,  ///< An event did not come, such as rest. The value is worse than every limit.
  late,   ///< As `never`, for a time. Quantiles are over all moves, and count it as later than any time.
  none    ///< There is nothing to measure, such as an oscillation. The move meets every limit.
};

enum class Worse { less, more };

/// Values of the moves that count, in statistics and in outputs of a trial.
struct CountedValues {
  bool needs_target{false};         ///< undefined for moves to a torque level; a sum over them is 0
  bool needs_motion{false};         ///< undefined for moves whose motion was lost
  Missing missing{Missing::never};  ///< meaning of NaN
  bool negative_is_missing{false};  ///< Negative values mean the same as NaN.
  Worse worse{Worse::more};         ///< whether larger or smaller values are worse; orders Missing::never
  bool magnitude{false};            ///< statistics are of the absolute value
  bool mirrored{false};             ///< has the opposite sign in a move of the opposite direction
};

/// How the values of the moves make one value of their trial.
enum class MoveReduction {
  all,      ///< a quality: 1 where every move has it, otherwise 0
  any,      ///< a quality: 1 where some move has it
  sum,      ///< over the moves
  largest,  ///< largest absolute value
  last      ///< that of the last move
};

/// A statistic of the values at a point, in the order of every report. Names and meanings: statistic_kinds()
/// of analysis/measures.
enum class Statistic {
  count,  ///< trials with the quality
  rate,
  rate_low,
  rate_high,
  rate_wilson_low,
  rate_wilson_high,
  moves_rate,  ///< moves with the quality, as a proportion of the moves
  moves_rate_low,
  moves_rate_high,
  n,       ///< values
  all,     ///< values, with those that are later than any
  trials,  ///< trials, or values, above 0
  mean,
  student_low,  ///< bounds of the mean
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
  whole_max,  ///< as a whole number; 0 of no values
  total,
  bootstrap_low,  ///< bounds of the mean, which only summaries have
  bootstrap_high
};

/// Statistics and their long name, in which {0} stands for what a statistic is, such as "5 % quantile" or
/// "lower bound of the mean", and {1} for the bound alone, "lower bound".
struct StatisticText {
  std::vector<Statistic> statistics;
  std::string_view long_name;
  std::string_view name{};  ///< where it is not that of the statistic
};

/// The statistics reported of a measure.
struct ReportedStatistics {
  std::string_view group{};            ///< of the JSON; empty: the statistics stand at the top
  std::vector<StatisticText> texts{};  ///< in any order
  std::string_view stem{};             ///< of names at the top, where it is not the measure's name
};

/// How the cell of a column is written.
/// `percent`: a proportion; the proportions of trials and of moves are of the numbers of them that the
/// statistic counts.
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
  bool study::StudyFeatures::*use{nullptr};  ///< what a study must make use of to have them; null: nothing
  std::vector<SummaryColumn> columns{};
  std::string legend{};  ///< whole lines that explain the columns
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
  double absolute{0.0};  ///< default margin, in the measure's unit
  double relative{0.0};  ///< default margin, as a proportion of the baseline's value
};

/// One measure of a move.
struct Measure {
  RecordField<trial::MoveOutcome> field;
  std::optional<std::int64_t> band{};  ///< of a measure of an error band: its limit, counts
  std::optional<double> tolerance{};   ///< of a measure of a tolerance of the position error: it, rad
  bool study::StudyFeatures::*only_with{nullptr};  ///< the extra without which no file has it
  CountedValues values{};
  MoveReduction reduction{MoveReduction::last};
  ReportedStatistics point{};  ///< at a design point
  ReportedStatistics level{};  ///< at a torque level of an open-loop study
  SummaryColumns summary{};
  std::optional<ExplainedOutput> output{};
  std::optional<GatedMeasure> gate{};
};

/// Whether a file with these features has the measure.
bool is_in_file(const Measure& measure, const study::StudyFeatures& features);

/// Whether the moves have, or lack, the measure as a quality.
bool is_quality(const Measure& measure);
bool has_quality(const Measure& measure, const trial::MoveOutcome& move);
/// 1 of each move that has the quality, 0 of others.
void qualities_of(const Measure& measure, std::span<const trial::MoveOutcome* const> moves,
                  std::span<double> qualities);

/// Orders that reports of earlier versions have: the measures named here come first, the others follow in the
/// order of the table.
enum class ReportOrder { statistics, levels, summary, outputs };

/// The measures of the table that `belongs` picks, in the order of the report. They point into the table.
std::vector<const Measure*> measures_of(const MeasureTable& measures, ReportOrder order,
                                        bool (*belongs)(const Measure&));

/// The measures of a move that do not depend on the study, in the order of the file.
MeasureTable move_measures();

/// The measures of the error band number `slot`, in the order of band_fields().
std::vector<Measure> measures_of_band(const trial::ErrorBands& bands, std::size_t slot);

/// The settling time of the tolerance number `slot`.
std::vector<Measure> measures_of_tolerance(const trial::Tolerances& tolerances, std::size_t slot);

}  // namespace zerocount::layout
