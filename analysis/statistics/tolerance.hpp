#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "analysis/statistics/proportion.hpp"

/// Tolerance statements: what proportion of all axes that the manifest describes succeed, or settle in time,
/// with a stated confidence. Distribution-free; the trials must be independent.
namespace zerocount {

/// Rank of the observation that is an upper tolerance limit: at least the proportion `content` of all is not
/// above it, with the stated confidence. The smallest u with P(B ≤ u − 1) ≥ confidence, B binomial (n,
/// content); n + 1 where there are too few observations. Source: Wilks, Ann. Math. Statist. 12 (1941) 91;
/// David and Nagaraja, Order Statistics, section 7.2.
/// @throws Failure (bad_input) for a content or confidence outside (0, 1).
std::int64_t tolerance_rank(std::int64_t observations, double content, double confidence);

/// The proportions of axes for which a summary gives a tolerance limit of the settling time.
inline constexpr std::array<double, 3> tolerance_contents{0.95, 0.99, 0.999};

/// An upper tolerance limit of the settling time.
struct ToleranceLimit {
  double content{0.0};                                      ///< the proportion of axes
  double within{std::numeric_limits<double>::quiet_NaN()};  ///< s; NaN where there is no limit
};

/// What the trials of a point show of the axes that the manifest describes.
struct SuccessClaim {
  std::int64_t trials{0};
  std::int64_t failures{0};
  double confidence{summary_confidence};
  double success_at_least{0.0};  ///< proportion of axes, proportion_at_least
  double failure_at_most{1.0};   ///< its complement
  double success_at_most{
      1.0};              ///< proportion of axes, proportion_at_most, of which both are not claimed at once
  std::int64_t rigs{0};  ///< that the trials ran on; 0: each trial is an axis of its own
};

/// From trials whose number was chosen before they were run.
SuccessClaim success_claim(std::int64_t successes, std::int64_t trials, double confidence);

/// From trials that went on until their outcomes were known well enough: by confidence_sequence_bounds, which
/// holds however often one looked.
SuccessClaim success_claim_at_any_time(std::int64_t successes, std::int64_t trials, double confidence);

/// What both claims allow, about the same trials: the first with the weaker bounds of the two.
SuccessClaim weaker_claim(const SuccessClaim& one, const SuccessClaim& other);

/// −ln(1 − confidence)/n, 3/n at 95 %, n the trials or, where they share rigs, the rigs: about
/// failure_at_most where there was no failure; NaN where there was one.
double rule_of_three(const SuccessClaim& claim);

/// "at least 99.9 % of axes succeed, with 95 % confidence", with the numbers of trials and failures. Shares
/// are rounded to the side that keeps the sentence true. Without a failure it says what 100 % of the trials
/// are worth; without a success, what proportion succeeds at most.
std::string claim_sentence(const SuccessClaim& claim);

/// "95 % settle within 0.062 s, 99 % within 0.081 s": the limits that there are; empty where there are none.
std::string settling_sentence(std::span<const ToleranceLimit> limits);

/// A proportion as a percentage, rounded down: to two significant digits of the proportion or of what is
/// missing to 100 %, whichever is less, and to one decimal where both are beyond 1 %.
std::string percent_at_least(double proportion);
/// A proportion as a percentage, rounded up: to two significant digits, and to one decimal beyond 1 %.
std::string percent_at_most(double proportion);

}  // namespace zerocount
