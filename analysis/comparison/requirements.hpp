#pragma once

#include "analysis/comparison/comparison.hpp"
#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/point_trials.hpp"

namespace zerocount::comparison {

/// Judges a requirement at one point by one-sided bounds: it passes where the bound against the limit, at
/// `confidence`, meets it; it fails where the other bound, at `failing_confidence`, contradicts it; otherwise
/// it is inconclusive.
///
/// Proportions have Clopper–Pearson bounds. A quantile of the settling time of a trial (that of its slowest
/// move; infinite if a move did not arrive) is judged as the proportion of trials that settle within the
/// limit L: q_p ≤ L holds if that proportion is at least p. Its bounds are those of this proportion. The mean
/// of the jerks has the bounds of cautious_bounds().
RequirementResult judge_requirement(const Requirement& requirement, const PointTrials& trials,
                                    double confidence, double failing_confidence);

/// The confidence with which each of `count` requirements must be contradicted, so that with this confidence
/// none of those that are met fails (Bonferroni): 1 − (1 − confidence)/count.
double failing_confidence(double confidence, std::int64_t count);

}  // namespace zerocount::comparison
