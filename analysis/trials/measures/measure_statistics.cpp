#include "analysis/trials/measures/measure_statistics.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace zerocount::measures {

const MeasureStatistics& named(const StatisticsOfMeasures& statistics, std::string_view name) {
  for (const layout::Measure& measure : *statistics.table) {
    if (measure.field.column.name == name) return statistics.of(measure);
  }
  throw std::invalid_argument(fmt::format("there are no statistics of {}", name));
}

const MeasureStatistics& of_band(const StatisticsOfMeasures& statistics, std::string_view name,
                                 std::int64_t band) {
  return named(statistics, layout::name_of_band(name, band));
}

std::span<const StatisticKind> statistic_kinds() {
  using enum layout::Statistic;
  using M = const MeasureStatistics&;
  static constexpr auto number = [](std::int64_t count) { return static_cast<double>(count); };
  static constexpr std::string_view lower = "lower 95 % bound", upper = "upper 95 % bound";
  static constexpr std::string_view lower_wilson = "lower 95 % Wilson bound",
                                    upper_wilson = "upper 95 % Wilson bound";
  static constexpr std::string_view lower_order = "lower 95 % order-statistic bound",
                                    upper_order = "upper 95 % order-statistic bound";
  static constexpr StatisticKind kinds[] = {
      {count, "", "", "", true, [](M s) { return number(s.trials); }},
      {rate, "rate", "", "", false, [](M s) { return s.rate.value; }},
      {rate_low, "rate_low", "", lower, false, [](M s) { return s.rate.clopper_pearson.low; }},
      {rate_high, "rate_high", "", upper, false, [](M s) { return s.rate.clopper_pearson.high; }},
      {rate_wilson_low, "rate_wilson_low", "", lower_wilson, false, [](M s) { return s.rate.wilson.low; }},
      {rate_wilson_high, "rate_wilson_high", "", upper_wilson, false, [](M s) { return s.rate.wilson.high; }},
      {moves_rate, "moves_rate", "", "", false, [](M s) { return s.moves_rate.value; }},
      {moves_rate_low, "moves_rate_low", "", lower, false,
       [](M s) { return s.moves_rate.clopper_pearson.low; }},
      {moves_rate_high, "moves_rate_high", "", upper, false,
       [](M s) { return s.moves_rate.clopper_pearson.high; }},
      {n, "n", "", "", true, [](M s) { return number(s.n); }},
      {all, "moves", "", "", true, [](M s) { return number(s.moves); }},
      {trials, "trials", "", "", true, [](M s) { return number(s.trials); }},
      {mean, "mean", "mean", "", false, [](M s) { return s.mean; }},
      {student_low, "low", "the mean", lower, false, [](M s) { return s.mean_bounds.low; }},
      {student_high, "high", "the mean", upper, false, [](M s) { return s.mean_bounds.high; }},
      {sd, "sd", "standard deviation", "", false, [](M s) { return s.sd; }},
      {rms, "rms", "root mean square", "", false, [](M s) { return s.rms; }},
      {min, "min", "smallest", "", false, [](M s) { return s.min; }},
      {p05, "p05", "5 % quantile", "", false, [](M s) { return s.p05.value; }},
      {p25, "p25", "25 % quantile", "", false, [](M s) { return s.p25.value; }},
      {median, "median", "median", "", false, [](M s) { return s.median.value; }},
      {median_low, "median_low", "the median", lower_order, false, [](M s) { return s.median.low; }},
      {median_high, "median_high", "the median", upper_order, false, [](M s) { return s.median.high; }},
      {p75, "p75", "75 % quantile", "", false, [](M s) { return s.p75.value; }},
      {p95, "p95", "95 % quantile", "", false, [](M s) { return s.p95.value; }},
      {p95_low, "p95_low", "the 95 % quantile", lower_order, false, [](M s) { return s.p95.low; }},
      {p95_high, "p95_high", "the 95 % quantile", upper_order, false, [](M s) { return s.p95.high; }},
      {max, "max", "largest", "", false, [](M s) { return s.max; }},
      {whole_max, "max", "largest", "", true, [](M s) { return s.n == 0 ? 0.0 : s.max; }},
      {total, "total", "", "", true, [](M s) { return number(s.total); }},
      {bootstrap_low, "mean_low", "the mean", "lower bound", false, [](M s) { return s.mean_bounds.low; }},
      {bootstrap_high, "mean_high", "the mean", "upper bound", false, [](M s) { return s.mean_bounds.high; }},
  };
  return kinds;
}

std::string meaning_of(const StatisticKind& kind) {
  return kind.bound.empty() ? std::string(kind.meaning) : fmt::format("{} of {}", kind.bound, kind.meaning);
}

double value_of(layout::Statistic statistic, const MeasureStatistics& statistics) {
  return statistic_kinds()[static_cast<std::size_t>(statistic)].value(statistics);
}

bool reports(const layout::ReportedStatistics& reported, layout::Statistic statistic) {
  return std::any_of(reported.texts.begin(), reported.texts.end(),
                     [statistic](const layout::StatisticText& text) {
                       return std::count(text.statistics.begin(), text.statistics.end(), statistic) > 0;
                     });
}

}  // namespace zerocount::measures
