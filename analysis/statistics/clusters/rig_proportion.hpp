#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::statistics {

/// Moves of one rig, of which some meet a requirement.
struct RigMoves {
  std::int64_t trials{0};  ///< independent, given the rig
  std::int64_t moves{0};   ///< of all trials, each with as many
  std::int64_t met{0};

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.moves, self.met);
  }
};

/// The proportion π of all rigs that meet the requirement in at least the proportion q of their moves, with
/// one-sided bounds. p_r, the proportion of rig r in infinitely many moves, is not known: the rig was seen in
/// n moves only.
///
/// A rig with p_r < q shows c or more moves of n with a probability of at most ε(c), a rig with p_r ≥ q fewer
/// than c with at most δ(c). With P the proportion of all rigs that show c or more,
///
///   P ≤ π + (1 − π)·ε(c),   P ≥ π·(1 − δ(c)),
///
/// so that the Clopper–Pearson bounds L and U of P give
///
///   π ≥ (L − ε(c))/(1 − ε(c)),   π ≤ U/(1 − δ(c)).
///
/// For trials of one move ε and δ are tails of the binomial distribution (n, q). Moves of one trial may be
/// correlated. For several moves they are the bounds of Chernoff and Hoeffding for the mean of m trials with
/// values in [0, 1], exp(−m·KL(c/n‖q)); Hoeffding, J. Amer. Statist. Assoc. 58 (1963) 13, theorem 1.
///
/// The thresholds c depend on n, q, the number of rigs and `wanted`, not on the observations: for the lower
/// bound the smallest c with ε(c) ≤ (L* − wanted)/(2·(1 − wanted)), L* being L if all rigs pass, or c = n;
/// for the upper bound the largest c with δ(c) ≤ (1 − wanted)/2.
struct RigProportion {
  std::int64_t meeting{0};  ///< rigs with met/moves ≥ q
  double low{0.0};
  double high{1.0};
};

/// The thresholds c of the two bounds, and how they mislead. A rig passes that shows c moves or more.
struct RigThresholds {
  std::int64_t low{0};     ///< for the lower bound
  std::int64_t high{0};    ///< for the upper bound
  double false_pass{1.0};  ///< ε(low)
  double false_fail{0.0};  ///< δ(high)
};

/// @param rig of which trials and moves count @param rigs their number
RigThresholds rig_thresholds(const RigMoves& rig, std::int64_t rigs, double proportion, double wanted,
                             double confidence);

/// The bounds of π where so many of the rigs pass the threshold of each.
double rigs_at_least(const RigThresholds& thresholds, std::int64_t passing, std::int64_t rigs,
                     double confidence);
double rigs_at_most(const RigThresholds& thresholds, std::int64_t passing, std::int64_t rigs,
                    double confidence);

/// @param rigs with moves each @param proportion q @param wanted the proportion of rigs that is asked about
/// @param confidence of each bound
RigProportion rig_proportion(std::span<const RigMoves> rigs, double proportion, double wanted,
                             double confidence);

}  // namespace zerocount::statistics
