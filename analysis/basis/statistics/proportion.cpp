#include "analysis/basis/statistics/proportion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <boost/math/policies/error_handling.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/unknown.hpp"
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

/// Quantile p of the distribution Beta(a, b). `inverse` computes it by Boost; if Boost's iteration does not
/// end (from some 10¹¹ trials on), the root of the rising function `excess` is used.
template <class Inverse, class Excess>
double inverse_of_beta(const Inverse& inverse, double a, double b, const Excess& excess) {
  try {
    return inverse();
  } catch (const boost::math::evaluation_error&) {
    constexpr double standard_deviations = 40.0;  // beyond any tail that a confidence gives
    constexpr int bits = 52;
    const double mean = a / (a + b);
    const double reach = standard_deviations * std::sqrt(mean * (1.0 - mean) / (a + b + 1.0));
    std::uintmax_t steps = 200;
    const auto [low, high] =
        boost::math::tools::toms748_solve(excess, std::max(0.0, mean - reach), std::min(1.0, mean + reach),
                                          boost::math::tools::eps_tolerance<double>(bits), steps);
    return std::midpoint(low, high);
  }
}

}  // namespace

void require_open_unit(const char* what, double value) {
  if (value > 0.0 && value < 1.0) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("a {} of {}; expected a number between 0 and 1", what, value));
}

double confidence_of_each(double confidence, std::size_t statements) {
  return 1.0 - (1.0 - confidence) / static_cast<double>(statements);
}

double bernoulli_divergence(double y, double q) {
  const auto term = [](double a, double b) { return a > 0.0 ? a * std::log(a / b) : 0.0; };
  return term(y, q) + term(1.0 - y, 1.0 - q);
}

double rate(std::int64_t successes, std::int64_t trials) {
  if (trials == 0) return unknown;
  return static_cast<double>(successes) / static_cast<double>(trials);
}

double lower_bound_on_p(double successes, double trials, double tail) {
  const double a = successes;
  const double b = trials - successes + 1.0;
  const auto inverse = [&] { return boost::math::ibeta_inv(a, b, tail); };
  return inverse_of_beta(inverse, a, b, [&](double p) { return boost::math::ibeta(a, b, p) - tail; });
}

double upper_bound_on_p(double successes, double trials, double tail) {
  const double a = successes + 1.0;
  const double b = trials - successes;
  const auto inverse = [&] { return boost::math::ibetac_inv(a, b, tail); };
  return inverse_of_beta(inverse, a, b, [&](double p) { return tail - boost::math::ibetac(a, b, p); });
}

ConfidenceInterval clopper_pearson(std::int64_t successes, std::int64_t trials, double confidence) {
  require_proportion(successes, trials, confidence);
  const double n = static_cast<double>(trials);
  const double k = static_cast<double>(successes);
  const double tail = 0.5 * (1.0 - confidence);
  return {successes == 0 ? 0.0 : lower_bound_on_p(k, n, tail),
          successes == trials ? 1.0 : upper_bound_on_p(k, n, tail)};
}

double proportion_at_least(std::int64_t successes, std::int64_t trials, double confidence) {
  require_proportion(successes, trials, confidence);
  if (successes == 0) return 0.0;
  return lower_bound_on_p(static_cast<double>(successes), static_cast<double>(trials), 1.0 - confidence);
}

double proportion_at_most(std::int64_t successes, std::int64_t trials, double confidence) {
  require_proportion(successes, trials, confidence);
  if (successes == trials) return 1.0;
  return upper_bound_on_p(static_cast<double>(successes), static_cast<double>(trials), 1.0 - confidence);
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
