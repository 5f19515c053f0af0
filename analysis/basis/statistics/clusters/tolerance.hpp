#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"

/// Tolerance statements: the proportion of all axes described by the manifest that succeed, or settle in
/// time, with a stated confidence. Distribution-free; the trials must be independent.
namespace zerocount::statistics {

/// Rank of the observation that is an upper tolerance limit: with the stated confidence, at least the
/// proportion `content` of the population is not above it. The smallest u with P(B ≤ u − 1) ≥ confidence, B
/// binomial (n, content); n + 1 if there are too few observations. Source: Wilks, Ann. Math. Statist. 12
/// (1941) 91; David and Nagaraja, Order Statistics, section 7.2.
/// @throws Failure (bad_input) for a content or confidence outside (0, 1).
std::int64_t tolerance_rank(std::int64_t observations, double content, double confidence);

/// The proportions of all machines for which a summary gives a time within which they settle (a tolerance
/// limit).
inline constexpr std::array<double, 3> tolerance_contents{0.95, 0.99, 0.999};

/// An upper tolerance limit of the settling time: a time within which a stated proportion of all machines
/// settles.
struct ToleranceLimit {
  double content{0.0};  ///< Proportion of machines to which the limit applies, such as 0.95.
  /// Time within which this proportion settles, s; NaN if there are too few trials for a limit.
  double within{unknown};
};

/// Tolerance statement about the success of all machines that the manifest describes, from the trials of a
/// point.
struct SuccessClaim {
  std::int64_t trials{0};
  std::int64_t failures{0};
  double confidence{summary_confidence};
  /// Lower bound of the proportion of machines that succeed, by proportion_at_least().
  double success_at_least{0.0};
  /// Upper bound of the proportion of machines that fail: 1 − success_at_least.
  double failure_at_most{1.0};
  /// Upper bound of the proportion of machines that succeed, by proportion_at_most(). It is not claimed
  /// together with success_at_least.
  double success_at_most{1.0};
  /// Number of machines that ran the trials; 0: every trial has a machine of its own.
  std::int64_t machines{0};
};

/// Claim on the proportion of machines that succeed, from a number of trials that was fixed in advance.
SuccessClaim success_claim(std::int64_t successes, std::int64_t trials, double confidence);

/// Claim on the proportion of machines that succeed, from a number of trials that depended on the outcomes
/// (sequential stopping), by confidence_sequence_bounds().
SuccessClaim success_claim_at_any_time(std::int64_t successes, std::int64_t trials, double confidence);

/// Combines two claims about the same trials: `one`, but with the weaker of both claims' bounds.
SuccessClaim weaker_claim(const SuccessClaim& one, const SuccessClaim& other);

/// Approximate upper bound of the proportion of failures when no trial failed (rule of three): −ln(1 −
/// confidence)/n, which is 3/n at 95 %, with n the number of trials, or of machines if trials share machines.
/// NaN if a trial failed.
double rule_of_three(const SuccessClaim& claim);

/// Sentence for a claim: "at least 99.9 % of axes succeed, with 95 % confidence", with the numbers of trials
/// and failures. Proportions are rounded to the safe side. Without a failure the sentence adds the upper
/// bound of the failures; without a success it gives the upper bound of the successes.
std::string claim_sentence(const SuccessClaim& claim, std::string_view succeed = "succeed");

/// Sentence for tolerance limits of the settling time: "95 % settle within 0.062 s, 99 % within 0.081 s";
/// empty without limits.
std::string settling_sentence(std::span<const ToleranceLimit> limits);

}  // namespace zerocount::statistics
