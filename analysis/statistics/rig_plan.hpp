#pragma once

#include <cstdint>

/// How many rigs, and trials on each, a claim needs before they are run.
namespace zerocount {

/// A study of `rigs` rigs with `trials_per_rig` trials each.
struct RigPlan {
  std::int64_t rigs{0};
  std::int64_t trials_per_rig{0};
};

/// The fewest rigs, with so many trials on each, for which the Korn–Graubard bounds of a success rate have no
/// more than this half-width, where the variance between rigs is what it is expected to be. With p the rate
/// and s the standard deviation of the success probability between rigs, one trial of m on each of R rigs is
/// worth
///
///   1/deff = 1/(1 + (m − 1)·ρ),   ρ = s²/(p(1 − p)),
///
/// independent ones (Kish), so that however many trials a rig runs, R rigs are worth R/ρ trials at most.
/// @throws Failure (bad_input) for a half-width or rate outside (0, ½) and (0, 1), a standard deviation that
/// no distribution with this mean has (s² > p(1 − p)), or a plan of more than 10⁹ rigs.
std::int64_t rigs_for_halfwidth(double halfwidth, double confidence, double rate, double rig_sd,
                                std::int64_t trials_per_rig);

/// The plan that shows, without a failure, that at least the proportion `content` of all rigs hold zero in at
/// least the proportion `success` of moves (rig_tolerance()), with trials of one move.
///
/// @param rigs 0: the fewest that can show it, plus half of that, which takes far fewer trials on each
/// @throws Failure (bad_input) for a number outside (0, 1), or fewer rigs than can show it.
RigPlan plan_tolerance(double content, double success, double confidence, std::int64_t rigs = 0);

}  // namespace zerocount
