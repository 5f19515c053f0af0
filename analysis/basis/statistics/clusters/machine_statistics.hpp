#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"

/// Statistics of the differences in success between machines. Repeatability concerns the trials of one
/// machine, robustness the differences between machines.
namespace zerocount::statistics {

/// The trials of one machine at a design point.
struct MachineTrials {
  std::int64_t trials{0};
  std::int64_t successes{0};   ///< Number of trials in which all moves ended at zero error.
  std::int64_t moves{0};       ///< Number of moves with a target.
  std::int64_t zero_moves{0};  ///< Number of moves with a target that ended at zero error.

  MachineTrials& operator+=(const MachineTrials& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.successes, self.moves, self.zero_moves);
  }
};

/// "At least the proportion `content` of all machines hold zero in at least the proportion `zero_at_least` of
/// their moves."
struct MachineTolerance {
  double content{0.9};
  double confidence{summary_confidence};
  /// Lower bound of the proportion of moves with zero error; NaN if there are too few machines.
  double zero_at_least{unknown};
  std::int64_t min_machines{0};  ///< Smallest number of machines for which such a statement is possible.
};

/// The bound of a MachineTolerance from R machines, for any distribution between machines. The trials of one
/// machine must be independent given the machine.
///
/// 1. Sort the R observed proportions of zero moves; y is the r-th smallest. With the stated confidence, at
///    most the proportion p_r of all machines shows less than y, where p_r is the one-sided Clopper–Pearson
///    upper bound for r − 1 hits in R.
/// 2. Let L be the one-sided lower bound from y with confidence 1 − δ. A machine whose true proportion is
/// below L
///    shows y or more with a probability of at most δ.
/// 3. Therefore at most the proportion p_r/(1 − δ) of all machines is below L. It equals 1 − content for
///    δ = 1 − p_r/(1 − content).
///
/// The rank r is the largest with δ ≥ ¼, or else 1: it depends on R only, not on the observations.
///
/// For trials of one move L is the Clopper–Pearson bound. Moves of one trial may be correlated. For several
/// moves L is therefore the Chernoff–Hoeffding bound for the mean of m independent trials with values in [0,
/// 1]: m·KL(y‖L) = −ln δ, KL(y‖q) = y·ln(y/q) + (1 − y)·ln((1 − y)/(1 − q)). Sources: Wilks, Ann. Math.
/// Statist. 12 (1941) 91; Hoeffding, J. Amer. Statist. Assoc. 58 (1963) 13, theorem 1.
MachineTolerance machine_tolerance(std::span<const MachineTrials> machines, double content,
                                   double confidence);

/// The smallest number of machines for a MachineTolerance (first function); and the allowance δ of the
/// statement for a number of machines, 0 below that minimum (second function).
std::int64_t min_machines_for_tolerance(double content, double confidence);
double tolerance_allowance(std::int64_t machines, double content, double confidence);

/// Sentence for a tolerance statement: "with 95 % confidence at least 90 % of machines hold zero in at least
/// 97 % of moves", the last number rounded down; or the number of machines that such a statement needs.
std::string tolerance_sentence(const MachineTolerance& tolerance);

/// Differences between machines at a design point. NaN without machines.
struct MachineStatistics {
  std::int64_t n{0};  ///< Number of machines.
  /// Standard deviation between machines of the probability of success: the moment estimate of the
  /// beta-binomial distribution, √max(0, S² − Σp̂ᵢ(1 − p̂ᵢ)/(R·(m − 1))) with S² the variance of the machines'
  /// success rates p̂ᵢ of m trials each. NaN for one trial per machine. Source: Kleinman, J. Amer. Statist.
  /// Assoc. 68 (1973) 46.
  double success_sd{unknown};
  /// Proportion of machines without a failed trial, with Clopper–Pearson bounds. It holds for this number of
  /// trials per machine.
  double without_failure{unknown};
  ConfidenceInterval without_failure_bounds{unknown, unknown};
  /// Mean observed success rate of the ⌈R/20⌉ worst machines. With few trials per machine it is biased below
  /// their true success probability, because the selection favours machines with bad luck.
  double worst_5_percent{unknown};
  ClusterSums successes;  ///< Sums of the trials' successes; each machine is a cluster.
  std::vector<std::int64_t> successes_of_machines;  ///< [machine] Number of successful trials on the machine.
  std::int64_t trials_of_machine{0};                ///< Number of trials on each machine.
  MachineTolerance tolerance;
};

/// Statistics of the differences in success between machines.
/// @param machines machines with the same number of trials, 1 or more
/// @throws Failure (bad_input) for a confidence outside (0, 1).
MachineStatistics machine_statistics(std::span<const MachineTrials> machines,
                                     double confidence = summary_confidence);

/// Tolerance statement for a trial on any machine (success rate over trials and machines together), from the
/// one-sided Korn–Graubard bounds.
/// @param successes sums of the trials' successes; each machine is a cluster
SuccessClaim success_claim_on_machines(const ClusterSums& successes, double confidence);

}  // namespace zerocount::statistics
