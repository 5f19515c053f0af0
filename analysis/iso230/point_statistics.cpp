#include "analysis/iso230/point_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "analysis/statistics/unknown.hpp"

namespace zerocount::iso230 {

ValueStatistics statistics_of(std::vector<double> values, double confidence) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  // Sorted before they are summed: the same mean in whatever order the trials come.
  std::sort(values.begin(), values.end());
  ValueStatistics result;
  result.n = std::ssize(values);
  statistics::Histogram<double> histogram;
  for (const double value : values) histogram.add(value);
  result.median = statistics::quantile(histogram, 0.5, confidence);
  result.p95 = statistics::quantile(histogram, 0.95, confidence);
  if (values.empty()) return result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  result.max = values.back();
  return result;
}

const std::vector<ValueStatisticField>& value_statistic_fields() {
  using enum layout::Statistic;
  static const std::vector<ValueStatisticField> fields = [] {
    std::vector<ValueStatisticField> all;
    for (const layout::Statistic one : {mean, median, median_low, median_high, p95, p95_low, p95_high, max}) {
      const measures::StatisticKind& kind = measures::statistic_kinds()[static_cast<std::size_t>(one)];
      all.push_back({kind.name, measures::meaning_of(kind) + (one == max ? "" : " of the"),
                     one == median || one == p95, kind.value});
    }
    return all;
  }();
  return fields;
}

const std::vector<text::ReportField<PointRepeatability>>& point_repeatability_fields() {
  using P = const PointRepeatability&;
  static const std::vector<text::ReportField<PointRepeatability>> fields{
      {"", "trials", "1", "trials of the point", true, [](P p) { return text::to_double(p.trials); }},
      {"", "evaluated", "1", "trials without a nonfinite move, of which the values are", true,
       [](P p) { return text::to_double(p.evaluated); }},
      {"", "zero_repeatability", "1",
       "trials whose repeatability by the fine encoder is exactly 0, NaN of a single cycle", true,
       [](P p) {
         return p.zero_repeatability ? text::to_double(*p.zero_repeatability) : statistics::unknown;
       }},
      {"", "zero_repeatability_rate", "1",
       "zero_repeatability as a proportion of trials, NaN of a single cycle", false,
       [](P p) { return p.zero_rate; }},
      {"", "zero_repeatability_rate_low", "1",
       "lower 95 % bound of zero_repeatability_rate: Clopper-Pearson, with rigs Korn-Graubard", false,
       [](P p) { return p.zero_bounds.low; }},
      {"", "zero_repeatability_rate_high", "1",
       "upper 95 % bound of zero_repeatability_rate: Clopper-Pearson, with rigs Korn-Graubard", false,
       [](P p) { return p.zero_bounds.high; }},
  };
  return fields;
}

}  // namespace zerocount::iso230
