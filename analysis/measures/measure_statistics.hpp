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

/// Proportion of trials, with bounds; NaN where there are none that could be a part of it.
struct RateWithBounds {
  double value{statistics::unknown};
  statistics::ConfidenceInterval clopper_pearson{statistics::unknown, statistics::unknown};
  statistics::ConfidenceInterval wilson{statistics::unknown, statistics::unknown};
};

/// The statistics of one measure over the moves or, of a sum or a quality, over the trials: in the measure's
/// unit, NaN where there is none. Only what its row of the table reports is worked out.
struct MeasureStatistics {
  static constexpr statistics::Quantile no_quantile{statistics::unknown, statistics::unknown,
                                                    statistics::unknown};
  std::int64_t n{0};                  ///< values that are known
  std::int64_t moves{0};              ///< values, including the censored ones
  std::int64_t nonfinite{0};          ///< values left out because they are not finite
  std::int64_t trials{0};             ///< trials with the quality, or values above 0
  std::int64_t total{0};              ///< sum of the values of the trials
  std::vector<std::int64_t> by_move;  ///< [move] of a quality: trials whose move has it
  RateWithBounds rate;                ///< of trials with the quality
  RateWithBounds moves_rate;  ///< of moves with the quality; Korn–Graubard in place of Clopper–Pearson
  double mean{statistics::unknown};
  double sd{statistics::unknown};
  double rms{statistics::unknown};
  double min{statistics::unknown};
  double max{statistics::unknown};
  statistics::Quantile p05{no_quantile}, p25{no_quantile}, median{no_quantile}, p75{no_quantile},
      p95{no_quantile};
  statistics::ConfidenceInterval mean_bounds{
      statistics::unknown,
      statistics::unknown};  ///< Student's at a level; at a point by the bootstrap, if wanted
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
/// @throws std::invalid_argument where the table has none
const MeasureStatistics& named(const StatisticsOfMeasures& statistics, std::string_view name);

/// The statistics of a measure of an error band.
/// @throws std::invalid_argument where the table has no such measure of the band.
const MeasureStatistics& of_band(const StatisticsOfMeasures& statistics, std::string_view name,
                                 std::int64_t band);

/// Name and value of a statistic.
struct StatisticKind {
  layout::Statistic statistic;
  std::string_view name;     ///< empty: the name of the measure
  std::string_view meaning;  ///< for the long name
  std::string_view bound{};  ///< for the long name, before the meaning
  bool whole{false};
  double (*value)(const MeasureStatistics&);
};

/// All of them, in the order of Statistic.
std::span<const StatisticKind> statistic_kinds();

/// "lower 95 % bound of the mean".
std::string meaning_of(const StatisticKind& kind);

/// The value of a statistic.
double value_of(layout::Statistic statistic, const MeasureStatistics& statistics);

/// Whether `reported` contains the statistic.
bool reports(const layout::ReportedStatistics& reported, layout::Statistic statistic);

}  // namespace zerocount::measures
