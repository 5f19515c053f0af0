#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {

/// What one unit shows of a claim: the moves that the goal is about, under the condition.
struct ClaimResult {
  std::int32_t moves{0};
  std::int32_t met{0};         ///< moves that meet the goal
  std::vector<double> values;  ///< [move] of the criterion's measure, where it has one; infinite for never
};

/// The result of a candidate on one unit of the search: a machine or, where no goal asks for machines, a
/// trial on a machine of its own, under each condition.
struct UnitResult {
  std::vector<ClaimResult> claims;  ///< as Aim::claims
  bool slid{false};                 ///< whether the axis slid in a move
};

/// Proportion of the moves that meet the goal; 0 without moves.
inline double met_proportion(const ClaimResult& claim) {
  return claim.moves == 0 ? 0.0 : static_cast<double>(claim.met) / claim.moves;
}

/// What must hold: a goal under a condition.
struct Claim {
  double moves{0.99};                ///< study::Goal::moves
  std::optional<double> machines{};  ///< study::Goal::machines
};

/// The requirements on the candidates: all claims must hold.
struct Aim {
  std::vector<Claim> claims{Claim{}};  ///< goal by goal, each under every condition
  std::size_t conditions{1};           ///< claims of each goal
  double quantile{0.95};               ///< the criterion is this quantile of the values; 0 to 1
  /// Unit i is in world i mod worlds, and the claims must hold in each; 0: no worlds.
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
/// is of all. Of several claims they are of the worst: the one whose rate is least above the wanted one, as
/// the difference of the logits. The criterion is the largest of all claims.
struct Estimate {
  double rate{0.0};       ///< of moves that meet the goal; with Claim::machines of units that do
  double moves{0.0};      ///< rate of moves that meet the goal
  double criterion{0.0};  ///< infinite for never
  std::int64_t units{0};  ///< that the rates are of; with worlds those of each
  /// Mean over the worlds of their rate, of each at most the one wanted: how near all of them are to it.
  double near_goal{0.0};
  std::vector<double> rates{};  ///< [claim]
  std::size_t worst{0};         ///< the claim that rate and moves are of
  double margin{0.0};           ///< of it: the difference of the logits
  std::int64_t missing{0};      ///< goals that the candidate does not seem to meet, under some condition
};

/// @param count of these units; all if there are fewer
Estimate estimate_of(const Aim& aim, std::span<const UnitResult> units, std::int64_t count);

/// Those of several candidates, [candidate].
std::vector<Estimate> estimates_of(const Aim& aim, std::span<const Candidate> candidates, std::int64_t units);

/// The rate that is claimed.
inline double wanted_rate(const Claim& claim) {
  return claim.machines.value_or(claim.moves);
}

/// Whether the candidate meets all goals by its units, each with one standard error to spare: a candidate
/// that meets them just so would not pass the proof.
inline bool seems_to_meet(const Estimate& estimate) {
  return estimate.units > 0 && estimate.missing == 0;
}

/// Whether every rate is as high as wanted, with nothing to spare.
bool reaches(const Aim& aim, const Estimate& estimate);

/// Whether every rate is as high as wanted, or less than two standard errors lower.
bool may_meet(const Aim& aim, const Estimate& estimate);

/// Whether `a` is the better candidate: one that seems to meet more of the goals is; of two that meet all of
/// them the smaller criterion is better; else the one whose worst claim is nearer to what is wanted.
bool is_better(const Aim& aim, const Estimate& a, const Estimate& b);

/// Loss of a unit, 0 to 1: the proportion of its moves that miss the goal, or 1 for a machine that does.
double goal_loss(const Claim& claim, const ClaimResult& result);

/// Quantile of a claim's values on these units; infinite without values.
double late_value(std::span<const UnitResult> units, std::size_t claim, double quantile);

/// Proportion of the values above `limit`.
double late_part(const ClaimResult& result, double limit);

/// Evidence against "the mean of the differences is at most 0", for differences within [−1, 1] of units that
/// are drawn independently: the mean of Π(1 + λ·d) over several bets λ. If the statement is true, the
/// evidence ever exceeds 1/α with probability α at most, however often one looks (Ville's inequality;
/// Waudby-Smith and Ramdas, "Estimating means of bounded random variables by betting", 2024).
double evidence_of_increase(std::span<const double> differences);

/// Whether all claims hold by the candidate's units (in every world), with this probability of an error at
/// most, at all numbers of units together. That all must hold needs no correction for their number.
bool surely_meets(const Aim& aim, const Candidate& candidate, double alpha);

/// Whether it misses some claim more often than allowed (in some world), and more often than `reliable` does;
/// corrected for the number of claims and worlds (Bonferroni).
bool surely_misses(const Aim& aim, const Candidate& candidate, const Candidate& reliable, double alpha);

/// Whether its values of some claim are more often above the criterion of `best`, by the units of both, than
/// those of `best` of the claim by which it is the latest; corrected for the number of claims.
bool is_significantly_later(const Aim& aim, const Candidate& candidate, const Candidate& best, double alpha);

/// A point that the search has simulated.
struct TriedPoint {
  Values values;
  Estimate estimate;  ///< by the most units that it was given
};

/// The frontier between success and speed: the points with at least `units` units that no other one of them
/// beats in both the rate and the criterion, the fastest first.
std::vector<TriedPoint> frontier_of(std::span<const TriedPoint> tried, std::int64_t units);

/// What the rates of the points of a search tell of the values between them.
struct Landscape {
  std::int64_t points{0};  ///< that were simulated
  /// Points at which some moves meet the worst goal for sure, more than 1 % of them, and fewer than it asks.
  std::int64_t telling{0};
  /// Whether more moves meet it at one point than at another for sure: moves that are trivial meet it at all.
  bool varies{false};

  /// Whether the rates led somewhere: they vary, and at least ten points, and one in twenty, are telling.
  /// Where the rate is the same nearly everywhere, 0 or another, no point tells where to go, and a narrow
  /// range of good values may lie between them.
  bool leads() const;
};

Landscape landscape_of(const Aim& aim, std::span<const TriedPoint> tried);

}  // namespace zerocount::tuning
