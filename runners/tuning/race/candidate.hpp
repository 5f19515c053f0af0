#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {

/// The result of a candidate on one unit of the search: a machine or, where the goal does not ask for
/// machines, a trial on a machine of its own.
struct UnitResult {
  std::int32_t moves{0};
  std::int32_t met{0};         ///< moves that meet the goal
  std::vector<double> values;  ///< [move] of the criterion's measure, where it has one; infinite for never
  bool slid{false};            ///< whether the axis slid in a move
};

/// Proportion of a unit's moves that meet the goal; 0 without moves.
inline double met_proportion(const UnitResult& unit) {
  return unit.moves == 0 ? 0.0 : static_cast<double>(unit.met) / unit.moves;
}

/// The requirements on the candidates.
struct Aim {
  double moves{0.99};                ///< study::Goal::moves
  std::optional<double> machines{};  ///< study::Goal::machines
  double quantile{0.95};             ///< the criterion is this quantile of the values; 0 to 1
  /// Unit i is in world i mod worlds, and the goal must be met in each; 0: no worlds.
  std::int64_t worlds{0};
};

/// A point of the search and its results on the units 0, 1, ….
struct Candidate {
  UnitCubePoint place;
  Values values;
  std::vector<UnitResult> units;
};

/// Whether the axis slid in one of the units.
inline bool has_slid(std::span<const UnitResult> units) {
  return std::ranges::any_of(units, &UnitResult::slid);
}

/// Estimates from a candidate's first units; with worlds the rates are those of the worst, and the criterion
/// is of all.
struct Estimate {
  double rate{0.0};       ///< of moves that meet the goal; with Aim::machines of units that do
  double moves{0.0};      ///< rate of moves that meet the goal
  double criterion{0.0};  ///< infinite for never
  std::int64_t units{0};  ///< that the rates are of; with worlds those of each
  /// Mean over the worlds of their rate, of each at most the one wanted: how near all of them are to it.
  double near_goal{0.0};
};

/// @param units how many; all if there are fewer
Estimate estimate_of(const Aim& aim, const Candidate& candidate, std::int64_t units);

/// The rate that the goal asks for.
inline double wanted_rate(const Aim& aim) {
  return aim.machines.value_or(aim.moves);
}

/// Whether the candidate meets the goal by its units, with one standard error to spare: a candidate that
/// meets it just so would not pass the proof.
bool seems_to_meet(const Aim& aim, const Estimate& estimate);

/// Whether `a` is the better candidate: one that seems to meet the goal is better than one that does not; of
/// two that do, the smaller criterion is, and of two that do not, the higher rate.
bool is_better(const Aim& aim, const Estimate& a, const Estimate& b);

/// Loss of a unit, 0 to 1: the proportion of its moves that miss the goal, or 1 for a machine that does.
double goal_loss(const Aim& aim, const UnitResult& unit);

/// Proportion of a unit's values above `limit`.
double late_part(const UnitResult& unit, double limit);

/// Evidence against "the mean of the differences is at most 0", for differences within [−1, 1] of units that
/// are drawn independently: the mean of Π(1 + λ·d) over several bets λ. If the statement is true, the
/// evidence ever exceeds 1/α with probability α at most, however often one looks (Ville's inequality;
/// Waudby-Smith and Ramdas, "Estimating means of bounded random variables by betting", 2024).
double evidence_of_increase(std::span<const double> differences);

/// Whether the candidate meets the goal by its units (in every world), with this probability of an error at
/// most, at all numbers of units together.
bool surely_meets(const Aim& aim, const Candidate& candidate, double alpha);

/// Whether it misses the goal more often than allowed (in some world), and more often than `reliable` does.
bool surely_misses(const Aim& aim, const Candidate& candidate, const Candidate& reliable, double alpha);

/// Whether its values are more often above the criterion of `best`, by the units of both, than those of
/// `best`.
bool is_significantly_later(const Aim& aim, const Candidate& candidate, const Candidate& best, double alpha);

}  // namespace zerocount::tuning
