#include "analysis/statistics/sample_size.hpp"

#include <algorithm>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <fmt/format.h>

#include "analysis/statistics/proportion.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::statistics {
namespace {

constexpr std::int64_t max_trials = 1'000'000'000'000;
constexpr std::int64_t max_failures = 1'000'000'000;

[[noreturn]] void too_many(const char* what) {
  throw Failure(ExitCode::bad_input, fmt::format("{} would need more than {} trials", what, max_trials));
}

/// The smallest number from `low` on with holds(number). `holds` must be monotonic: false, then true.
template <typename Predicate>
std::int64_t least(std::int64_t low, std::int64_t limit, const char* what, const Predicate& holds) {
  std::int64_t high = std::max<std::int64_t>(low, 1);
  while (!holds(high)) {
    if (high >= limit) too_many(what);
    low = high + 1;
    high = std::min(limit, 2 * high);
  }
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (holds(middle)) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return high;
}

/// Half the length of the Clopper–Pearson interval of n·rate successes of n, as a continuous function of n.
double halfwidth_of(double n, double rate, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  const double successes = n * rate;
  const double failures = n - successes;
  const double low = boost::math::ibeta_inv(successes, failures + 1.0, tail);
  const double high = boost::math::ibetac_inv(successes + 1.0, failures, tail);
  return 0.5 * (high - low);
}

}  // namespace

std::int64_t trials_for_claim(double success, double confidence, std::int64_t failures) {
  require_open_unit("success rate", success);
  require_confidence(confidence);
  if (failures < 0)
    throw Failure(ExitCode::bad_input, fmt::format("{} failures; expected 0 or more", failures));
  return least(failures + 1, max_trials, "the claim", [&](std::int64_t trials) {
    return chance_of_claim(trials, failures, success) <= 1.0 - confidence;
  });
}

double chance_of_claim(std::int64_t trials, std::int64_t failures, double true_success) {
  if (failures >= trials) return 1.0;
  // P(B ≤ r): the (r + 1)-th smallest of n uniform numbers is larger than 1 − success.
  return boost::math::ibeta(static_cast<double>(trials - failures), static_cast<double>(failures) + 1.0,
                            true_success);
}

ClaimPlan plan_with_power(double success, double confidence, double true_success, double power) {
  require_open_unit("success rate", success);
  require_open_unit("true success rate", true_success);
  require_open_unit("power", power);
  if (!(true_success > success)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("a true success rate of {} does not exceed the {} that is claimed; no number of "
                    "trials would show it",
                    true_success, success));
  }
  const std::int64_t failures = least(0, max_failures, "the power", [&](std::int64_t allowed) {
    return chance_of_claim(trials_for_claim(success, confidence, allowed), allowed, true_success) >= power;
  });
  return {failures, trials_for_claim(success, confidence, failures)};
}

std::int64_t trials_for_halfwidth(double halfwidth, double confidence, double rate) {
  if (!(halfwidth > 0.0 && halfwidth < 0.5)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("a half-width of {}; expected a number between 0 and 0.5", halfwidth));
  }
  require_confidence(confidence);
  require_open_unit("success rate", rate);
  return least(1, max_trials, "the half-width", [&](std::int64_t trials) {
    return halfwidth_of(static_cast<double>(trials), rate, confidence) <= halfwidth;
  });
}

}  // namespace zerocount::statistics
