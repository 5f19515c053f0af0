#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "experiments/study/goal.hpp"
#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {

/// Result of one machine for one claim (a goal in a setting). Only moves that the claim's goal judges, in the
/// setting of the claim, are counted.
struct ClaimResult {
  std::int32_t moves{0};  ///< Number of the machine's moves that the claim's goal judges.
  std::int32_t met{0};    ///< Number of these moves that meet the goal.
  /// Values of the measure to be minimised, one for each judged move that has a value; infinity for "never".
  std::vector<double> values;
};

/// Result of one machine with the values of a candidate, over its trials in each setting (condition at an
/// age). If no goal asks for machines, each machine has one trial in each setting.
struct MachineResult {
  /// Result for each claim (a goal in a setting), in the order of Aim::claims.
  std::vector<ClaimResult> claims;
  bool slid{false};  ///< Whether the axis slid (the friction contact broke away) in some judged move.
};

/// Proportion of the judged moves of a machine that meet the goal; 0 without judged moves.
inline double met_proportion(const ClaimResult& claim) {
  return claim.moves == 0 ? 0.0 : static_cast<double>(claim.met) / claim.moves;
}

/// Requirements on the candidates of a tuning. All claims must hold.
struct Aim {
  /// The goals of the study, each once for every setting (condition at an age), goal by goal. A goal in a
  /// setting is a claim.
  std::vector<study::Goal> claims{study::Goal{}};
  /// Number of settings (conditions at ages), which is the number of claims per goal.
  std::size_t settings{1};
  /// Probability (0 to 1) of the quantile that is the criterion, the value to be minimised.
  double quantile{0.95};
  /// Number of worlds (draws of the values that all machines share and nobody knows); 0: no worlds. Machine i
  /// belongs to world i mod worlds. The claims must hold in each world.
  std::int64_t worlds{0};
};

/// A set of values of the free parameters that the search tries, and its results on the machines 0, 1, ….
struct Candidate {
  UnitCubePoint place;
  Values values;
  std::vector<MachineResult> machines;
};

/// Whether the axis slid (the friction contact broke away) on one of the machines.
inline bool has_slid(std::span<const MachineResult> machines) {
  return std::ranges::any_of(machines, &MachineResult::slid);
}

/// Estimates of the success rates and the criterion from the first machines of a candidate.
///
/// `rate`, `moves` and `margin` describe the worst claim. It is the claim with the smallest difference
/// between the logits of its rate and of the wanted rate. With worlds (draws of the values that all machines
/// share), rates are those of the worst world, whereas the criterion is computed from the machines of all
/// worlds.
struct RateEstimate {
  /// Proportion of moves that meet the goal of the worst claim. If the claim is about machines: proportion of
  /// machines.
  double rate{0.0};
  /// Proportion of moves that meet the goal of the worst claim, also if the claim is about machines.
  double moves{0.0};
  /// Largest value of the criterion, the quantity to be minimised, over all claims; infinity for "never".
  double criterion{0.0};
  /// Number of machines from which the rates are computed. With worlds (draws of the values that all machines
  /// share): in each world.
  std::int64_t machines{0};
  /// Mean over claims and worlds of the rate, each capped at the wanted rate. Larger is better: it shows how
  /// close all worlds are to the goals.
  double near_goal{0.0};
  /// [claim] Proportion of moves or of machines that meet the claim's goal, defined as `rate`.
  std::vector<double> rates{};
  std::size_t worst{0};  ///< Index in Aim::claims of the worst claim (goal in a setting).
  /// Logit of the worst claim's rate minus the logit of its wanted rate. Positive if the rate is higher than
  /// wanted.
  double margin{0.0};
  /// Number of goals that the candidate seems to miss in some setting (condition at an age).
  std::int64_t missing{0};
};

/// Estimate from the first `count` of these machines; from all if there are fewer.
RateEstimate estimate_of(const Aim& aim, std::span<const MachineResult> machines, std::int64_t count);

/// [candidate] Estimate of each candidate from its first `machines` machines.
std::vector<RateEstimate> estimates_of(const Aim& aim, std::span<const Candidate> candidates,
                                       std::int64_t machines);

/// Whether the rates from the candidate's machines meet all goals with one standard error to spare. A
/// candidate that barely meets the goals would not pass the proof.
inline bool seems_to_meet(const RateEstimate& estimate) {
  return estimate.machines > 0 && estimate.missing == 0;
}

/// Whether the observed rate of every claim is at least the wanted one. No standard error is added.
bool reaches(const Aim& aim, const RateEstimate& estimate);

/// Whether the candidate may still meet all claims: no observed rate is more than two standard errors below
/// the wanted one.
bool may_meet(const Aim& aim, const RateEstimate& estimate);

/// Whether the candidate with the estimate `a` is better than the one with `b`. The candidate that seems to
/// meet more goals is better. If both meet all goals, the smaller criterion is better. Otherwise the
/// candidate whose worst claim is closer to the wanted rate is better; with worlds, the larger near_goal is.
bool is_better(const Aim& aim, const RateEstimate& a, const RateEstimate& b);

/// Loss of a machine for a claim, 0 to 1. For a claim about machines, the loss is 1 if the machine misses the
/// goal. For other claims, it is the proportion of the machine's moves that miss the goal.
double goal_loss(const study::Goal& claim, const ClaimResult& result);

/// Quantile of the criterion's values of one claim, pooled over these machines; infinity without values.
double late_value(std::span<const MachineResult> machines, std::size_t claim, double quantile);

/// Proportion of a machine's criterion values that are above `limit`; 0 without values.
double late_part(const ClaimResult& result, double limit);

/// Evidence against "the mean of the differences is at most 0", for differences within [−1, 1] of machines
/// that are drawn independently: the mean of Π(1 + λ·d) over several bets λ. If the statement is true, the
/// evidence ever exceeds 1/α with probability α at most, however often one looks (Ville's inequality;
/// Waudby-Smith and Ramdas, "Estimating means of bounded random variables by betting", 2024).
double evidence_of_increase(std::span<const double> differences);

/// Whether the candidate's machines show that all claims (goals in settings) hold, in every world (draw of
/// the values that all machines share). The probability of ever being wrong is at most alpha, however many
/// machines have run when this is asked. The number of claims needs no correction because all of them must
/// hold.
bool surely_meets(const Aim& aim, const Candidate& candidate, double alpha);

/// Whether the candidate misses, with statistical significance, some claim in some world, more often than
/// allowed and more often than the candidate `reliable` does.
/// @param alpha error probability; it is divided by the number of claims and worlds (Bonferroni)
bool surely_misses(const Aim& aim, const Candidate& candidate, const Candidate& reliable, double alpha);

/// Whether the candidate is significantly worse than `best` by the criterion, on the machines that both have
/// run. For some claim, its values must exceed the criterion of `best` more often than the values of `best`
/// do in the claim that sets this criterion.
/// @param alpha error probability; it is divided by the number of claims (Bonferroni)
bool is_significantly_later(const Aim& aim, const Candidate& candidate, const Candidate& best, double alpha);

/// A set of values that the search has simulated, with its estimated rates and criterion.
struct TriedPoint {
  Values values;
  RateEstimate estimate;  ///< Estimate from the largest number of machines that ran with these values.
};

/// Frontier between success and speed: the tried points that no other point beats in both rate and criterion,
/// sorted by ascending criterion. Only points with at least `machines` machines are compared.
std::vector<TriedPoint> frontier_of(std::span<const TriedPoint> tried, std::int64_t machines);

/// Summary of the success rates over the simulated points. It shows whether the search had a direction to
/// follow, or may have overlooked good values between the points.
struct Landscape {
  std::int64_t points{0};  ///< Number of simulated points (sets of values).
  /// Number of telling points. At a telling point the rate is below what the worst goal asks for, but surely
  /// (95 % lower bound) more than 1 % of the moves meet the goal.
  std::int64_t telling{0};
  /// Whether surely more moves meet the worst goal at some point than at another (95 % bounds). Trivial moves
  /// meet it at every point, so they do not make the rates vary.
  bool varies{false};

  /// Whether the rates gave the search a direction: they vary, and at least ten points and one in twenty are
  /// telling. If the rate is nearly the same everywhere, no point shows where to go. A narrow range of good
  /// values may then lie between the points.
  bool leads() const;
};

Landscape landscape_of(const Aim& aim, std::span<const TriedPoint> tried);

}  // namespace zerocount::tuning
