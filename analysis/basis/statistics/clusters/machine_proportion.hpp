#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"

namespace zerocount::statistics {

/// Numbers of moves of one machine, and of those that meet a requirement.
struct MachineMoves {
  std::int64_t trials{0};  ///< Number of trials of the machine. They are independent given the machine.
  std::int64_t moves{0};   ///< Number of moves of all trials; every trial has the same number.
  std::int64_t met{0};

  MachineMoves& operator+=(const MachineMoves& other) {
    trials += other.trials;
    moves += other.moves;
    met += other.met;
    return *this;
  }
  bool operator==(const MachineMoves&) const = default;

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.trials, self.moves, self.met);
  }
};

/// One-sided bounds of the proportion π of all machines that meet the requirement in at least the proportion
/// q of their moves. The proportion p_r of machine r in infinitely many moves is not known, because the
/// machine was seen in only n moves.
struct MachineProportion {
  /// Number of observed machines whose observed proportion met/moves is at least q.
  std::int64_t meeting{0};
  double low{0.0};
  double high{1.0};
};

/// The claim on machines: the proportion `wanted` of them meets the requirement in the proportion q of
/// their moves.
struct MachineClaim {
  double proportion;  ///< Proportion q of its moves in which a machine must meet the requirement.
  double wanted;
  double confidence;  ///< Confidence of each one-sided bound.
  /// True if the requirement must be met in each of several settings (conditions at ages). A machine then
  /// counts with the fewest moves met in any of them. These numbers may depend on each other, so the ratio of
  /// two tails is not known. Used only for `low`.
  bool of_least{false};
};

/// The size of a study on machines: numbers of machines, trials and moves.
struct MachineStudy {
  std::int64_t machines{0};
  std::int64_t trials{0};  ///< Number of trials of each machine.
  std::int64_t moves{0};   ///< Number of moves of each machine in all its trials.
  /// True if all machines have the same number of moves. Otherwise `trials` and `moves` belong to the machine
  /// with the fewest moves.
  bool all_alike{true};
};

/// Largest probability with which a machine that meets the requirement in the proportion p of its moves is
/// observed with `met` or more such moves: ε of MachineBound. It is exact for trials of one move.
double chance_to_show(const MachineStudy& study, double p, std::int64_t met);

/// A threshold on machines: a machine passes if c or more of its n moves meet the requirement.
struct MachineMark {
  std::int64_t met{0};  ///< Number c of moves that a machine must meet to pass.
  /// Number b: only machines that show b or more met moves are considered; 0: all machines.
  std::int64_t among{0};
  /// ρ: largest proportion of passing machines among the machines whose true proportion is below q and that
  /// show b or more met moves.
  double wrong{1.0};
};

/// Computes the lower bound of π, the proportion of all machines that meet the requirement in at least the
/// proportion q of their moves, from the numbers of machines that pass some marks (thresholds).
///
/// A machine with p_r < q shows c or more moves of n with a probability of at most ε(c), that of a machine on
/// q. For trials of one move it is the tail of the binomial distribution (n, q). Moves of one trial may be
/// correlated; then ε is the bound of Chernoff and Hoeffding for the mean of m trials with values in [0, 1],
/// exp(−m·KL(c/n‖q)); Hoeffding, J. Amer. Statist. Assoc. 58 (1963) 13, theorem 1. With P(c) the proportion
/// of all machines that show c or more,
///
///   P(c) ≤ π + (1 − π)·ε(c),   so that π ≥ (P(c) − ε(c))/(1 − ε(c)).
///
/// Machines far below q need not be allowed for: the ratio of two binomial tails rises with p (monotone
/// likelihood ratio), so that of the machines below q that show b or more at most ρ = ε(c)/ε(b) show c. Hence
///
///   P(c) ≤ ρ·P(b) + (1 − ρ)·π,   π ≥ P(b)·(P(c)/P(b) − ρ)/(1 − ρ),
///
/// of which the former is the case b = 0. P(b) and P(c)/P(b) are proportions with Clopper–Pearson bounds.
///
/// The best mark depends on the machines: a high one where they hardly ever miss, a low one where they are
/// well above q and miss at times. So there are several, and the error 1 − γ is divided among them
/// (Bonferroni); the bound is the best of theirs. A mark that cannot show a proportion π₀ even if all
/// machines pass takes no part in showing π₀ or more, and leaves its error to the others:
///
///   low = 0; marks = all
///   repeat
///     found = largest bound of the marks, which share 1 − γ by their weights
///     reach = smallest of the bounds that the marks have if all machines pass
///     low = max(low, found)
///     if found < reach or one mark is left: return low
///     low = max(low, reach); leave out the mark with the smallest reach
///
/// Each π₀ is so tested by marks that depend on π₀ and the size of the study alone, which makes the bound
/// valid for each size and distribution of the machines. If all machines pass it is that of the highest mark
/// alone.
class MachineBound {
 public:
  MachineBound(const MachineStudy& study, const MachineClaim& claim);

  /// The lower bound of π, the proportion of all machines that meet the requirement in the proportion q of
  /// their moves.
  /// @param passing returns the number of machines that show `met` or more moves that meet the requirement
  double at_least(const std::function<std::int64_t(std::int64_t met)>& passing) const;

  /// An observed result that suffices to show the wanted proportion: at least `machines` machines show `met`
  /// or more moves that meet the requirement.
  struct Enough {
    std::int64_t met{0};
    /// Number of machines. If it exceeds the number of machines in the study, no number suffices.
    std::int64_t machines{0};
  };
  /// [mark] The results that suffice, one for each mark (threshold) that considers all machines.
  std::vector<Enough> enough() const;

 private:
  /// A mark (threshold on machines) that is tested, and the part of the error probability 1 − γ that it may
  /// use.
  struct Tested {
    MachineMark mark;
    double error;
  };
  /// A range of proportions π₀, up to `reach`, that are tested by the same marks (thresholds).
  struct Stage {
    std::vector<Tested> marks;
    double reach;
  };

  double bound(const Tested& tested, std::int64_t passing, std::int64_t among) const;

  MachineStudy study_;
  MachineClaim claim_;
  std::vector<Stage> stages_{};
};

/// Bounds of the proportion of machines that meet the requirement in at least the proportion q of their
/// moves. The upper bound is 1 minus the lower bound of the proportion of machines that miss the requirement
/// in more than 1 − q of their moves.
/// @param machines machines with at least one move each
MachineProportion machine_proportion(std::span<const MachineMoves> machines, const MachineClaim& claim);

/// The complementary claim, with misses in place of met moves: on the machines that do not meet the
/// requirement.
MachineClaim of_missing(const MachineClaim& claim);

}  // namespace zerocount::statistics
