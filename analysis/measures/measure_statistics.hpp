#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/sums/moments.hpp"
#include "analysis/statistics/unknown.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {

/// Proportion of trials, with bounds; NaN without trials.
struct RateWithBounds {
  double value{statistics::unknown};
  statistics::ConfidenceInterval clopper_pearson{statistics::unknown, statistics::unknown};
  statistics::ConfidenceInterval wilson{statistics::unknown, statistics::unknown};
};

/// Statistics of one measure, in the unit of the measure: over the moves, or over the trials for a sum or a
/// quality. NaN without values. Only the statistics that the measure's row of the table reports are computed.
struct MeasureStatistics {
  static constexpr statistics::Quantile no_quantile{statistics::unknown, statistics::unknown,
                                                    statistics::unknown};
  std::int64_t n{0};          ///< values that are known
  std::int64_t moves{0};      ///< values, including the censored ones
  std::int64_t nonfinite{0};  ///< values left out as not finite
  std::int64_t trials{0};     ///< Trials with the quality that the measure states, or with a value above 0.
  std::int64_t total{0};      ///< sum of the values of the trials
  std::vector<std::int64_t> by_move;  ///< [move] number of trials whose move has the quality
  RateWithBounds rate;                ///< Proportion of trials with the quality that the measure states.
  /// Proportion of moves that have the quality which the measure states, such as "arrived". The bounds treat
  /// trials, or machines, as clusters of moves: `clopper_pearson` holds the bounds of Korn and Graubard here.
  RateWithBounds moves_rate;
  double mean{statistics::unknown};
  double sd{statistics::unknown};
  double rms{statistics::unknown};
  double min{statistics::unknown};
  double max{statistics::unknown};
  statistics::Quantile p05{no_quantile}, p25{no_quantile}, median{no_quantile}, p75{no_quantile},
      p95{no_quantile};
  /// Bounds of the mean: Student's t at a torque level; bootstrap at a point, if requested.
  statistics::ConfidenceInterval mean_bounds{statistics::unknown, statistics::unknown};
};

/// The statistics of all measures of a table.
struct StatisticsOfMeasures {
  const layout::MeasureTable* table{&layout::measure_table()};
  std::vector<MeasureStatistics> measures = std::vector<MeasureStatistics>(table->size());  ///< [row]

  /// @param measure of `table`.
  const MeasureStatistics& of(const layout::Measure& measure) const {
    return measures.at(static_cast<std::size_t>(&measure - table->data()));
  }
  /// The statistics of the measure that is this member of MoveOutcome.
  template <class Value>
  const MeasureStatistics& of(Value trial::MoveOutcome::*member) const {
    return measures[row_of(member)];
  }
  template <class Value>
  MeasureStatistics& of(Value trial::MoveOutcome::*member) {
    return measures[row_of(member)];
  }

 private:
  template <class Value>
  std::size_t row_of(Value trial::MoveOutcome::*member) const {
    std::size_t row = 0;
    while (table->at(row).field.member != layout::Member<trial::MoveOutcome>(member)) ++row;
    return row;
  }
};

/// The statistics of the measure with this name, such as "band_settling_time[1]".
/// @throws std::invalid_argument if the table has no such measure
const MeasureStatistics& named(const StatisticsOfMeasures& statistics, std::string_view name);

/// The statistics of a measure of an error band.
/// @throws std::invalid_argument if the table has no such measure of the band.
const MeasureStatistics& of_band(const StatisticsOfMeasures& statistics, std::string_view name,
                                 std::int64_t band);

/// Name, meaning and value of a statistic.
struct StatisticKind {
  layout::Statistic statistic;
  std::string_view name;     ///< empty: the name of the measure
  std::string_view meaning;  ///< Long name; for a bound, the long name of what is bounded: "the mean".
  std::string_view bound{};  ///< Kind of bound, "lower 95 % bound"; empty if the statistic is not a bound.
  bool whole{false};
  double (*value)(const MeasureStatistics&);
};

/// All kinds of statistics, in the order of layout::Statistic.
std::span<const StatisticKind> statistic_kinds();

/// Long name of the statistic: "lower 95 % bound of the mean".
std::string meaning_of(const StatisticKind& kind);

/// The value of a statistic.
double value_of(layout::Statistic statistic, const MeasureStatistics& statistics);

/// Whether `reported` contains the statistic.
bool reports(const layout::ReportedStatistics& reported, layout::Statistic statistic);

}  // namespace zerocount::measures
