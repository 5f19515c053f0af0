#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/tolerance.hpp"

/// How much rigs differ in their success: repeatability is what one rig does again and again, robustness
/// what is the same on every rig.
namespace zerocount {

/// The trials of one rig at a design point.
struct RigTrials {
  std::int64_t trials{0};
  std::int64_t successes{0};   ///< trials all of whose moves ended at zero error
  std::int64_t moves{0};       ///< moves with a target
  std::int64_t zero_moves{0};  ///< of them, those that ended at zero error
};

/// "At least the proportion `content` of all rigs hold zero in at least the proportion `zero_at_least` of
/// their moves."
struct RigTolerance {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double content{0.9};
  double confidence{summary_confidence};
  double zero_at_least{unknown};  ///< NaN where there are too few rigs
  std::int64_t min_rigs{0};       ///< with which something can be said
};

/// The bound of a RigTolerance from R rigs, whatever the distribution between rigs; trials of one rig must be
/// independent given the rig.
///
/// Rank and allowance are chosen by R alone. For rank r, let p_r be the one-sided Clopper–Pearson upper bound
/// of a proportion of which r − 1 in R were seen: with the stated confidence, rigs whose observed proportion
/// of zero moves is below the r-th smallest, y, are at most the proportion p_r of all. A rig whose true
/// proportion is below L shows y or more with a probability of at most δ, where L is the one-sided lower
/// bound of confidence 1 − δ from y. So rigs below L are at most p_r/(1 − δ) of all, which is 1 − content for
/// δ = 1 − p_r/(1 − content). r is the largest rank with δ ≥ ¼, or else 1.
///
/// L is Clopper–Pearson's for trials of one move. Moves of one trial may all be alike, so that for several
/// moves it is the bound of Chernoff and Hoeffding for the mean of m independent trials with values in [0,
/// 1]: m·KL(y‖L) = −ln δ, KL(y‖q) = y·ln(y/q) + (1 − y)·ln((1 − y)/(1 − q)). Sources: Wilks, Ann. Math.
/// Statist. 12 (1941) 91; Hoeffding, J. Amer. Statist. Assoc. 58 (1963) 13, theorem 1.
RigTolerance rig_tolerance(std::span<const RigTrials> rigs, double content, double confidence);

/// The fewest rigs with which a RigTolerance can say something, and the δ above of so many rigs (0 of fewer).
std::int64_t min_rigs_for_tolerance(double content, double confidence);
double tolerance_allowance(std::int64_t rigs, double content, double confidence);

/// "with 95 % confidence at least 90 % of rigs hold zero in at least 97 % of moves", the proportion rounded
/// down; or how many rigs such a statement takes.
std::string tolerance_sentence(const RigTolerance& tolerance);

/// How rigs differ at a design point. NaN where there are no rigs.
struct RigStatistics {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::int64_t n{0};  ///< rigs
  /// Standard deviation between rigs of the probability of success: the moment estimate of the beta-binomial
  /// distribution, √max(0, S² − Σp̂ᵢ(1 − p̂ᵢ)/(R·(m − 1))) with S² the variance of the rigs' success rates p̂ᵢ
  /// of m trials each. NaN with one trial a rig. Source: Kleinman, J. Amer. Statist. Assoc. 68 (1973) 46.
  double success_sd{unknown};
  /// Rigs all of whose trials succeeded, as a proportion of the rigs, with Clopper–Pearson bounds: of rigs
  /// that run as many trials.
  double without_failure{unknown};
  ConfidenceInterval without_failure_bounds{unknown, unknown};
  /// Mean success rate of the ⌈R/20⌉ rigs with the lowest, as observed: with few trials a rig it is lower
  /// than their probability of success, because chance decides who is among the worst.
  double worst_5_percent{unknown};
  ClusterSums successes;  ///< of the trials, a cluster for each rig
  RigTolerance tolerance;
};

/// @param rigs each with the same number of trials, 1 or more
/// @throws Failure (bad_input) for a confidence outside (0, 1).
RigStatistics rig_statistics(std::span<const RigTrials> rigs, double confidence = summary_confidence);

/// What the trials of rigs show of a trial on any rig: by the one-sided bounds of Korn and Graubard.
/// @param successes of the trials, a cluster for each rig
SuccessClaim success_claim_on_rigs(const ClusterSums& successes, double confidence);

}  // namespace zerocount
