#include "analysis/two_samples/mean_tests.hpp"

#include <cmath>
#include <numeric>
#include <vector>

#include "analysis/statistics/distributions.hpp"

namespace zerocount::two_samples {
namespace {

struct SampleMoments {
  double n{0.0};
  double mean{0.0};
  double variance_of_mean{0.0};
};

SampleMoments moments_of(std::span<const double> values) {
  SampleMoments moments{static_cast<double>(values.size()), 0.0, 0.0};
  moments.mean = std::accumulate(values.begin(), values.end(), 0.0) / moments.n;
  double squares = 0.0;
  for (const double value : values) squares += (value - moments.mean) * (value - moments.mean);
  moments.variance_of_mean = squares / (moments.n - 1.0) / moments.n;
  return moments;
}

double half_width(const MeanDifference& difference, double confidence) {
  if (difference.standard_error == 0.0) return 0.0;
  return statistics::student_t_quantile(difference.degrees_of_freedom, confidence) *
         difference.standard_error;
}

/// `values` and one more, `distance` beyond their mean.
std::vector<double> with_one_more(std::span<const double> values, double distance) {
  std::vector<double> more(values.begin(), values.end());
  more.push_back(moments_of(values).mean + distance);
  return more;
}

}  // namespace

MeanDifference mean_difference(std::span<const double> differences) {
  const SampleMoments moments = moments_of(differences);
  return {moments.mean, std::sqrt(moments.variance_of_mean), moments.n - 1.0};
}

MeanDifference mean_difference(std::span<const double> baseline, std::span<const double> current) {
  const SampleMoments one = moments_of(baseline);
  const SampleMoments two = moments_of(current);
  const double variance = one.variance_of_mean + two.variance_of_mean;
  const double spread = one.variance_of_mean * one.variance_of_mean / (one.n - 1.0) +
                        two.variance_of_mean * two.variance_of_mean / (two.n - 1.0);
  return {two.mean - one.mean, std::sqrt(variance), spread > 0.0 ? variance * variance / spread : 1.0};
}

double p_of(const MeanDifference& difference) {
  if (difference.standard_error == 0.0) {
    if (difference.value == 0.0) return 0.5;
    return difference.value > 0.0 ? 0.0 : 1.0;
  }
  return statistics::student_t_upper_tail(difference.degrees_of_freedom,
                                          difference.value / difference.standard_error);
}

statistics::ConfidenceInterval cautious_bounds(std::span<const double> differences, double unit,
                                               double confidence) {
  const MeanDifference lower = mean_difference(with_one_more(differences, -unit));
  const MeanDifference upper = mean_difference(with_one_more(differences, unit));
  return {lower.value - half_width(lower, confidence), upper.value + half_width(upper, confidence)};
}

statistics::ConfidenceInterval cautious_bounds(std::span<const double> baseline,
                                               std::span<const double> current, double unit,
                                               double confidence) {
  const MeanDifference lower = mean_difference(baseline, with_one_more(current, -unit));
  const MeanDifference upper = mean_difference(baseline, with_one_more(current, unit));
  return {lower.value - half_width(lower, confidence), upper.value + half_width(upper, confidence)};
}

}  // namespace zerocount::two_samples
