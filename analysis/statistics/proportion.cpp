#include "analysis/statistics/proportion.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/binomial.hpp>
#include <fmt/format.h>

#include "analysis/statistics/normal.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::statistics {
namespace {

void require_proportion(std::int64_t successes, std::int64_t trials, double confidence) {
  if (trials < 0 || successes < 0 || successes > trials) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("a rate of {} in {}; expected 0 ≤ successes ≤ trials", successes, trials));
  }
  require_confidence(confidence);
}

}  // namespace

void require_open_unit(const char* what, double value) {
  if (value > 0.0 && value < 1.0) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("a {} of {}; expected a number between 0 and 1", what, value));
}

double rate(std::int64_t successes, std::int64_t trials) {
  if (trials == 0) return unknown;
  return static_cast<double>(successes) / static_cast<double>(trials);
}

ConfidenceInterval clopper_pearson(std::int64_t successes, std::int64_t trials, double confidence) {
  require_proportion(successes, trials, confidence);
  using Binomial = boost::math::binomial_distribution<double>;
  const double n = static_cast<double>(trials);
  const double k = static_cast<double>(successes);
  const double tail = 0.5 * (1.0 - confidence);
  return {successes == 0 ? 0.0 : Binomial::find_lower_bound_on_p(n, k, tail),
          successes == trials ? 1.0 : Binomial::find_upper_bound_on_p(n, k, tail)};
}

double proportion_at_least(std::int64_t successes, std::int64_t trials, double confidence) {
  require_proportion(successes, trials, confidence);
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<double>::find_lower_bound_on_p(
      static_cast<double>(trials), static_cast<double>(successes), 1.0 - confidence);
}

double proportion_at_most(std::int64_t successes, std::int64_t trials, double confidence) {
  require_proportion(successes, trials, confidence);
  if (successes == trials) return 1.0;
  return boost::math::binomial_distribution<double>::find_upper_bound_on_p(
      static_cast<double>(trials), static_cast<double>(successes), 1.0 - confidence);
}

ConfidenceInterval wilson(std::int64_t successes, std::int64_t trials, double confidence) {
  require_proportion(successes, trials, confidence);
  if (trials == 0) return {0.0, 1.0};
  return wilson_interval(rate(successes, trials), static_cast<double>(trials),
                         two_sided_normal_quantile(confidence));
}

ConfidenceInterval wilson_interval(double p, double n, double z) {
  const double scale = 1.0 + z * z / n;
  const double centre = (p + z * z / (2.0 * n)) / scale;
  const double half_width = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / scale;
  return {p > 0.0 ? std::max(0.0, centre - half_width) : 0.0,
          p < 1.0 ? std::min(1.0, centre + half_width) : 1.0};
}

}  // namespace zerocount::statistics
