#pragma once

#include <cstddef>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/statistics/clusters/tolerance.hpp"
#include "analysis/statistics/proportion.hpp"

/// What the trials of a design point show of success, although the point was chosen by them.
///
/// The largest of several estimates is too large on average. Bounds of each of m points with the confidence
/// 1 − (1 − γ)/m hold for all of them together with the confidence γ, and so for whichever is chosen, by
/// whatever rule (Bonferroni; Miller, Simultaneous Statistical Inference, 2nd ed. 1981, section 2.3.5).
namespace zerocount::goal {

/// The claim of a point that was chosen from `points`.
/// @param stopped whether the outcomes decided the number of trials (`stop`)
statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped);

/// Two-sided bounds of the success rate of a point that was chosen from `points`: Clopper–Pearson, with rigs
/// Korn–Graubard, with `stop` the confidence sequence, or the outer of the two.
statistics::ConfidenceInterval bounds_of_chosen(const measures::PointSummary& point, std::size_t points,
                                                bool stopped, double confidence);

}  // namespace zerocount::goal
