#pragma once

#include <cstdint>

/// Planning: the number of rigs, and of trials on each, that a claim needs.
namespace zerocount::statistics {

/// A study of `rigs` rigs with `trials_per_rig` trials each.
struct RigPlan {
  std::int64_t rigs{0};
  std::int64_t trials_per_rig{0};
};

/// The minimum number of rigs, with `trials_per_rig` trials each, for which the Korn–Graubard bounds of a
/// success rate have at most this half-width. With p the rate and s the expected standard deviation of the
/// success probability between rigs, one of m trials on each of R rigs is equivalent to
///
///   1/deff = 1/(1 + (m − 1)·ρ),   ρ = s²/(p(1 − p)),
///
/// independent trials (Kish). R rigs are therefore equivalent to at most R/ρ independent trials, whatever m
/// is.
/// @throws Failure (bad_input) for a half-width or rate outside (0, ½) and (0, 1), a standard deviation that
/// no distribution with this mean has (s² > p(1 − p)), or a plan of more than 10⁹ rigs.
std::int64_t rigs_for_halfwidth(double halfwidth, double confidence, double rate, double rig_sd,
                                std::int64_t trials_per_rig);

/// The plan that shows, if no trial fails, that at least the proportion `content` of all rigs hold zero in at
/// least the proportion `success` of moves (rig_tolerance()). For trials of one move.
///
/// @param rigs 0: 1.5 times the minimum number, which needs far fewer trials on each rig than the minimum
/// @throws Failure (bad_input) for a number outside (0, 1), or fewer rigs than the minimum.
RigPlan plan_tolerance(double content, double success, double confidence, std::int64_t rigs = 0);

}  // namespace zerocount::statistics
