#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/basis/statistics/sums/moments.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::measures {

/// A proportion, usually of trials, with its bounds; NaN without trials.
struct RateWithBounds {
  double value{statistics::unknown};
  statistics::ConfidenceInterval clopper_pearson{statistics::unknown, statistics::unknown};
  statistics::ConfidenceInterval wilson{statistics::unknown, statistics::unknown};
};

/// Statistics of one measure, in its unit: over the moves, or over the trials for a measure that is a sum or
/// a quality. NaN without values. Only the statistics that the table of measures reports for this measure are
/// computed.
struct MeasureStatistics {
  static constexpr statistics::Quantile no_quantile{statistics::unknown, statistics::unknown,
                                                    statistics::unknown};
  std::int64_t n{0};      ///< Number of known values.
  std::int64_t moves{0};  ///< Number of values, including the censored ones (times that were not reached).
  std::int64_t nonfinite{0};  ///< Number of values left out because they are not finite.
  /// Number of trials with the quality that the measure states, or with a value above 0.
  std::int64_t trials{0};
  std::int64_t total{0};              ///< Sum of the values of the trials.
  std::vector<std::int64_t> by_move;  ///< [move] Number of trials in which this move has the quality.
  RateWithBounds rate;  ///< Proportion of trials with the quality that the measure states, such as success.
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
  /// Bounds of the mean: by Student's t at a torque level of an open-loop study; by bootstrap at a design
  /// point, if requested.
  statistics::ConfidenceInterval mean_bounds{statistics::unknown, statistics::unknown};
};

/// The statistics of all measures of a table.
struct StatisticsOfMeasures {
  const layout::MeasureTable* table{&layout::measure_table()};
  /// [row of the table] Statistics of the measure.
  std::vector<MeasureStatistics> measures = std::vector<MeasureStatistics>(table->size());

  /// Statistics of a measure.
  /// @param measure a row of `table`
  const MeasureStatistics& of(const layout::Measure& measure) const {
    return measures.at(static_cast<std::size_t>(&measure - table->data()));
  }
  /// Statistics of the measure whose values are this member of MoveOutcome, such as &MoveOutcome::outcome.
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

/// Statistics of the measure with this name, such as "band_settling_time[1]".
/// @throws std::invalid_argument if the table has no such measure
const MeasureStatistics& named(const StatisticsOfMeasures& statistics, std::string_view name);

/// Statistics of a measure of an error band.
/// @param name name without the band, such as "band_settling_time"
/// @param band size of the band, counts
/// @throws std::invalid_argument if the table has no such measure of the band
const MeasureStatistics& of_band(const StatisticsOfMeasures& statistics, std::string_view name,
                                 std::int64_t band);

/// Name, meaning and value of a kind of statistic, such as the mean.
struct StatisticKind {
  layout::Statistic statistic;
  /// Ending of the reported name, such as "mean"; empty: the number has the name of the measure itself.
  std::string_view name;
  /// Meaning of the statistic in words; for a bound, the quantity that is bounded: "the mean".
  std::string_view meaning;
  std::string_view bound{};  ///< Kind of bound, "lower 95 % bound"; empty if the statistic is not a bound.
  bool whole{false};
  double (*value)(const MeasureStatistics&);
};

/// All kinds of statistics of a measure, in the order of layout::Statistic.
std::span<const StatisticKind> statistic_kinds();

/// Meaning of the statistic in words: "lower 95 % bound of the mean".
std::string meaning_of(const StatisticKind& kind);

/// Value of a kind of statistic.
double value_of(layout::Statistic statistic, const MeasureStatistics& statistics);

/// Whether the statistic is among those that are reported.
bool reports(const layout::ReportedStatistics& reported, layout::Statistic statistic);

}  // namespace zerocount::measures
