#include "analysis/basis/statistics/mean_bounds.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::statistics {
namespace {

constexpr double prior = 0.5;  // both parameters of the mixture's Beta distribution

double log_beta(double a, double b) {
  using boost::math::lgamma;
  return lgamma(a) + lgamma(b) - lgamma(a + b);
}

/// The product k·ln(p), taken as 0 for k = 0 (also if p is 0).
double times_log(double k, double p) {
  return k > 0.0 ? k * std::log(p) : 0.0;
}

/// Root of the function `excess` between `inside` and `outside`; returns the end of the final bracket nearer
/// to `outside`.
template <class Excess>
double crossing(Excess excess, double inside, double outside) {
  const double low = std::min(inside, outside);
  const double high = std::max(inside, outside);
  if (!(excess(outside) > 0.0)) return outside;
  std::uintmax_t iterations = 200;
  const auto bracket = boost::math::tools::toms748_solve(
      excess, low, high, boost::math::tools::eps_tolerance<double>(48), iterations);
  return outside < inside ? bracket.first : bracket.second;
}

}  // namespace

ConfidenceInterval confidence_sequence_bounds(std::int64_t successes, std::int64_t trials,
                                              double confidence) {
  if (trials == 0) return {0.0, 1.0};
  const auto s = static_cast<double>(successes);
  const auto f = static_cast<double>(trials - successes);
  const double limit = -std::log1p(-confidence);  // log of 1/(1 − confidence)
  const double evidence = log_beta(s + prior, f + prior) - log_beta(prior, prior) - limit;
  const auto excess = [&](double p) { return evidence - times_log(s, p) - times_log(f, 1.0 - p); };
  const double proportion = s / (s + f);
  constexpr double edge = 1e-300;
  ConfidenceInterval bounds{0.0, 1.0};
  if (successes > 0)
    bounds.low = crossing(excess, proportion < 1.0 ? proportion : std::nextafter(1.0, 0.0), edge);
  if (successes < trials) {
    bounds.high = crossing(excess, proportion > 0.0 ? proportion : edge, std::nextafter(1.0, 0.0));
  }
  return bounds;
}

std::int64_t projected_trials(std::int64_t successes, std::int64_t trials, double halfwidth,
                              double confidence, std::int64_t block, std::int64_t max_trials) {
  const double proportion = trials > 0 ? static_cast<double>(successes) / static_cast<double>(trials) : 0.5;
  const auto narrow = [&](std::int64_t blocks) {
    const std::int64_t n = std::min(blocks * block, max_trials);
    const auto s = static_cast<std::int64_t>(std::llround(proportion * static_cast<double>(n)));
    return confidence_sequence_bounds(s, n, confidence).half_width() <= halfwidth;
  };
  const std::int64_t max_blocks = (max_trials + block - 1) / block;
  return std::min(numerics::first_where_by_doubling(1, max_blocks, narrow) * block, max_trials);
}

ConfidenceInterval student_t(const Moments& sample, double confidence) {
  require_confidence(confidence);
  if (sample.n < 2) {
    return {unknown, unknown};
  }
  const auto n = static_cast<double>(sample.n);
  const double t = student_t_quantile(n - 1.0, 0.5 * (1.0 + confidence));
  const double half_width = t * sample.sd() / std::sqrt(n);
  return {sample.mean - half_width, sample.mean + half_width};
}

ConfidenceInterval poisson_bounds(double events, double confidence) {
  require_confidence(confidence);
  if (!(events >= 0.0)) {
    throw Failure(ExitCode::bad_input, fmt::format("{} events; expected 0 or more", events));
  }
  const double tail = 0.5 * (1.0 - confidence);
  return {events == 0.0 ? 0.0 : boost::math::gamma_p_inv(events, tail),
          boost::math::gamma_q_inv(events + 1.0, tail)};
}

}  // namespace zerocount::statistics
