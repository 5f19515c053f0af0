#pragma once

#include <cstdint>
#include <vector>

#include "analysis/goal/question.hpp"

/// What the machines of a study with ages and a claim do over their life: a machine meets the question at an
/// age if it meets every goal in its proportion of moves, under every condition at this age.
namespace zerocount::goal {

/// [age] the proportion of machines that meet the question at the age, with one-sided bounds.
///
/// The bounds of one goal under one condition are those of a claim on machines (judge_goal()).
///
/// A machine that misses a goal under some condition shows c or more good moves under all of them no more
/// often than under that one. So the fewest good moves of a machine under any condition bound the machines
/// that meet the goal under all, as its good moves bound those that meet it under one (statistics::RigClaim),
/// however the moves under the conditions depend on each other. Of G goals the lower bound is 1 − Σ(1 − low
/// of each), each at the confidence 1 − (1 − γ)/G. The upper bound is the least of the K goals and
/// conditions, each at 1 − (1 − γ)/K (Bonferroni). With worlds they are those of the worst of them.
/// @param counts [goal of the study] (PointSummary::goals)
std::vector<BoundedProportion> machines_at_ages(const Question& question,
                                                const std::vector<measures::CellCounts>& counts);

/// [rig] the last age up to and including which it meets the question; NaN if it does not at the first.
std::vector<double> lives_of_rigs(const Question& question, const std::vector<measures::CellCounts>& counts);

/// Rigs that meet the question at every age up to one.
struct Survival {
  std::int64_t rigs{0};      ///< those
  BoundedProportion living;  ///< of the rigs, with one-sided Clopper–Pearson bounds
};
/// [age] the survival curve of these lives. @param confidence of each bound
std::vector<Survival> survival_of(const std::vector<double>& lives, const std::vector<double>& ages,
                                  double confidence);

}  // namespace zerocount::goal
