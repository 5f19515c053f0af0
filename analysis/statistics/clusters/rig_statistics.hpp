#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/clusters/tolerance.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"

/// How much rigs differ in their success. Repeatability concerns the trials of one rig, robustness the
/// differences between rigs.
namespace zerocount::statistics {

/// The trials of one rig at a design point.
struct RigTrials {
  std::int64_t trials{0};
  std::int64_t successes{0};   ///< trials all of whose moves ended at zero error
  std::int64_t moves{0};       ///< moves with a target
  std::int64_t zero_moves{0};  ///< of them, those that ended at zero error

  RigTrials& operator+=(const RigTrials& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.successes, self.moves, self.zero_moves);
  }
};

/// "At least the proportion `content` of all rigs hold zero in at least the proportion `zero_at_least` of
/// their moves."
struct RigTolerance {
  double content{0.9};
  double confidence{summary_confidence};
  double zero_at_least{unknown};  ///< NaN if there are too few rigs
  std::int64_t min_rigs{0};       ///< minimum number of rigs for such a statement
};

/// The bound of a RigTolerance from R rigs, for any distribution between rigs. The trials of one rig must be
/// independent given the rig.
///
/// 1. Sort the R observed proportions of zero moves; y is the r-th smallest. With the stated confidence, at
///    most the proportion p_r of all rigs shows less than y, where p_r is the one-sided Clopper–Pearson upper
///    bound for r − 1 hits in R.
/// 2. Let L be the one-sided lower bound from y with confidence 1 − δ. A rig whose true proportion is below L
///    shows y or more with a probability of at most δ.
/// 3. Therefore at most the proportion p_r/(1 − δ) of all rigs is below L. It equals 1 − content for
///    δ = 1 − p_r/(1 − content).
///
/// The rank r is the largest with δ ≥ ¼, or else 1: it depends on R only, not on the observations.
///
/// For trials of one move L is the Clopper–Pearson bound. Moves of one trial may be correlated. For several
/// moves L is therefore the Chernoff–Hoeffding bound for the mean of m independent trials with values in [0,
/// 1]: m·KL(y‖L) = −ln δ, KL(y‖q) = y·ln(y/q) + (1 − y)·ln((1 − y)/(1 − q)). Sources: Wilks, Ann. Math.
/// Statist. 12 (1941) 91; Hoeffding, J. Amer. Statist. Assoc. 58 (1963) 13, theorem 1.
RigTolerance rig_tolerance(std::span<const RigTrials> rigs, double content, double confidence);

/// The minimum number of rigs for a RigTolerance, and δ for a number of rigs (0 below the minimum).
std::int64_t min_rigs_for_tolerance(double content, double confidence);
double tolerance_allowance(std::int64_t rigs, double content, double confidence);

/// "with 95 % confidence at least 90 % of rigs hold zero in at least 97 % of moves", the last number rounded
/// down; or the number of rigs that such a statement needs.
std::string tolerance_sentence(const RigTolerance& tolerance);

/// Differences between rigs at a design point. NaN without rigs.
struct RigStatistics {
  std::int64_t n{0};  ///< rigs
  /// Standard deviation between rigs of the probability of success: the moment estimate of the beta-binomial
  /// distribution, √max(0, S² − Σp̂ᵢ(1 − p̂ᵢ)/(R·(m − 1))) with S² the variance of the rigs' success rates p̂ᵢ
  /// of m trials each. NaN for one trial per rig. Source: Kleinman, J. Amer. Statist. Assoc. 68 (1973) 46.
  double success_sd{unknown};
  /// Proportion of rigs without a failed trial, with Clopper–Pearson bounds. It holds for this number of
  /// trials per rig.
  double without_failure{unknown};
  ConfidenceInterval without_failure_bounds{unknown, unknown};
  /// Mean observed success rate of the ⌈R/20⌉ worst rigs. With few trials per rig it is biased below their
  /// true success probability, because the selection favours rigs with bad luck.
  double worst_5_percent{unknown};
  ClusterSums successes;                        ///< of the trials; each rig is a cluster
  std::vector<std::int64_t> successes_of_rigs;  ///< [rig]
  std::int64_t trials_of_rig{0};                ///< on each
  RigTolerance tolerance;
};

/// @param rigs each with the same number of trials, 1 or more
/// @throws Failure (bad_input) for a confidence outside (0, 1).
RigStatistics rig_statistics(std::span<const RigTrials> rigs, double confidence = summary_confidence);

/// Tolerance statement for a trial on any rig, from the one-sided Korn–Graubard bounds.
/// @param successes of the trials; each rig is a cluster
SuccessClaim success_claim_on_rigs(const ClusterSums& successes, double confidence);

}  // namespace zerocount::statistics
