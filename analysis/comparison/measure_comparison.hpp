#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/point_trials.hpp"

namespace zerocount::comparison {

/// Values that a mean must have, in both files, to be judged: fewer say nothing of a mean, and where so few
/// trials arrive it is the proportion of arrivals that is compared.
inline constexpr std::int64_t least_values = 20;

/// The tests of all judged measures at one point, without verdicts: the false discoveries are controlled over
/// all points.
/// @param paired trial i of both drew the same random numbers; both have the same number of trials then.
std::vector<MeasureComparison> compare_measures(const GateRules& rules, const std::string& label,
                                                const PointTrials& baseline, const PointTrials& current,
                                                bool paired);

/// Gives every measure its adjusted p-values and its verdict.
///
/// A measure fails where its adjusted p is at most the rate and its effect exceeds the margin; it passes
/// where the upper bound of its effect is below the margin (of both bounds, where it is judged both ways: two
/// one-sided tests, Schuirmann, Journal of Pharmacokinetics and Biopharmaceutics 15 (1987), 657). Otherwise
/// it is inconclusive.
/// @return the number of tests over which the false discoveries were controlled.
std::int64_t decide(std::span<PointComparison> points, const GateRules& rules);

/// Of several verdicts: regression before inconclusive before passed; not_measured where all are.
GateVerdict worst_of(std::span<const GateVerdict> verdicts);

}  // namespace zerocount::comparison
