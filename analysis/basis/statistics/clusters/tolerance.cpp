#include "analysis/basis/statistics/clusters/tolerance.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/text.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::statistics {
std::int64_t tolerance_rank(std::int64_t observations, double content, double confidence) {
  require_confidence(confidence);
  require_open_unit("content", content);
  return numerics::first_where(1, observations + 1, [&](std::int64_t rank) {
    return binomial_cdf(observations, content, rank - 1) >= confidence;
  });
}

SuccessClaim success_claim(std::int64_t successes, std::int64_t trials, double confidence) {
  const std::int64_t failures = trials - successes;
  return {trials,
          failures,
          confidence,
          proportion_at_least(successes, trials, confidence),
          proportion_at_most(failures, trials, confidence),
          proportion_at_most(successes, trials, confidence)};
}

SuccessClaim success_claim_at_any_time(std::int64_t successes, std::int64_t trials, double confidence) {
  require_confidence(confidence);
  const ConfidenceInterval bounds = confidence_sequence_bounds(successes, trials, confidence);
  return {trials, trials - successes, confidence, bounds.low, 1.0 - bounds.low, bounds.high};
}

SuccessClaim weaker_claim(const SuccessClaim& one, const SuccessClaim& other) {
  SuccessClaim claim = one;
  claim.success_at_least = std::min(one.success_at_least, other.success_at_least);
  claim.failure_at_most = std::max(one.failure_at_most, other.failure_at_most);
  claim.success_at_most = std::max(one.success_at_most, other.success_at_most);
  return claim;
}

double rule_of_three(const SuccessClaim& claim) {
  if (claim.failures > 0 || claim.trials == 0) return unknown;
  return -std::log1p(-claim.confidence) /
         static_cast<double>(claim.machines > 0 ? claim.machines : claim.trials);
}

std::string claim_sentence(const SuccessClaim& claim, std::string_view succeed) {
  if (claim.trials == 0) return "nothing: no trial";
  const std::string level = fmt::format("with {} confidence", text::percent(claim.confidence));
  const std::string subject = claim.machines > 0 ? "trials on all machines" : "axes";
  const std::string trials = fmt::format(
      "{} trials{}", claim.trials, claim.machines > 0 ? fmt::format(" on {} machines", claim.machines) : "");
  if (claim.failures == claim.trials) {
    return fmt::format("at most {} of {} {}, {} (no success in {})",
                       text::percent_at_most(claim.success_at_most), subject, succeed, level, trials);
  }
  const std::string statement = fmt::format(
      "at least {} of {} {}, {}", text::percent_at_least(claim.success_at_least), subject, succeed, level);
  if (claim.failures > 0) {
    return fmt::format("{} ({} {} in {})", statement, claim.failures,
                       claim.failures == 1 ? "failure" : "failures", trials);
  }
  return fmt::format("{} (no failure in {}: not 100 %, but at most {} fail)", statement, trials,
                     text::percent_at_most(claim.failure_at_most));
}

std::string settling_sentence(std::span<const ToleranceLimit> limits) {
  std::string sentence;
  for (const ToleranceLimit& limit : limits) {
    if (std::isnan(limit.within)) continue;
    sentence += fmt::format("{}{} {}within {} s", sentence.empty() ? "" : ", ", text::percent(limit.content),
                            sentence.empty() ? "arrive " : "", text::short_number(limit.within));
  }
  return sentence;
}

}  // namespace zerocount::statistics
