#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/measures/point_statistics.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/tolerance.hpp"
#include "analysis/summary/summary.hpp"

/// The best of several design points, and what its trials show although it was chosen by them.
///
/// The largest of several estimates is too large on average. Bounds of each of m points with the confidence
/// 1 − (1 − γ)/m hold for all of them together with the confidence γ, and so for whichever is chosen, by
/// whatever rule (Bonferroni; Miller, Simultaneous Statistical Inference, 2nd ed. 1981, section 2.3.5).
namespace zerocount::summary {

/// The points that have trials, the best first. With a goal these are the points with the largest proportion
/// of machines that meet the goal, or of moves where the goal does not ask for machines, or machines are
/// equal; among equals the one whose error is within the goal's band for good earliest (95 % quantile).
/// Without a goal it is the point with the highest success rate; among equals the one with the lowest median
/// of the arrival. Then the one with fewer swept parameters other than 0 or none; then the first. Points of
/// an open-loop study keep their order.
std::vector<std::int64_t> points_by_merit(const StudySummary& summary);

/// The first of them.
std::int64_t best_point(const StudySummary& summary);

/// The claim of a point that was chosen from `points`.
/// @param stopped whether the outcomes decided the number of trials (`stop`)
statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped);

/// Two-sided bounds of the success rate of a point that was chosen from `points`: Clopper–Pearson, with rigs
/// Korn–Graubard, with `stop` the confidence sequence, or the outer of the two.
statistics::ConfidenceInterval bounds_of_chosen(const measures::PointSummary& point, std::size_t points,
                                                bool stopped, double confidence);

}  // namespace zerocount::summary
