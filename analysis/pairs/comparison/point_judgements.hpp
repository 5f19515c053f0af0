#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/pairs/comparison/judgement.hpp"
#include "analysis/pairs/comparison/point_trials.hpp"
#include "analysis/pairs/two_samples/continued_sample.hpp"

/// The judgements on the trials of one design point: the values of the independent units, and the tests of
/// these values. A unit is a trial; if trials share machines or worlds, it is a machine or a world.
namespace zerocount::comparison {

/// Minimum number of values in each file for the comparison of a mean. If fewer trials have a value because
/// they do not arrive, the proportion of arrivals shows the difference.
inline constexpr std::int64_t min_values = 20;

/// The compared trials of one design point in the baseline and in the current file.
struct BothTrials {
  const PointTrials& baseline;
  const PointTrials& current;
  /// True: trial i drew the same random numbers in both files, and both have equal numbers of trials.
  bool paired{false};
};

/// The measures that are judged, by these rules, at a design point with these trials.
std::vector<GateMeasure> judged_measures(const GateRules& rules, const PointTrials& trials);

/// Tests all judged measures at the design point with this label. The verdicts are not set yet; decide() sets
/// them, which controls the false discovery rate over all points.
std::vector<Judgement> compare_measures(const GateRules& rules, const std::string& label,
                                        const BothTrials& trials);

/// The samples behind the results of compare_measures() with the same arguments, in the same order.
/// @param found results of compare_measures(); the sample of a quantile follows from its effect and bounds
std::vector<two_samples::Sample> measure_samples(const GateRules& rules, std::span<const Judgement> found,
                                                 const BothTrials& trials);

/// Judges a requirement at one point by one-sided bounds. It passes if the less favourable bound, at
/// `confidence`, meets the limit. It fails if the more favourable bound, at `failing_confidence`, contradicts
/// the limit. Otherwise it is inconclusive.
///
/// Proportions have Clopper–Pearson bounds. The settling time of a trial is that of its slowest move;
/// infinite if a move did not arrive. A quantile of it is judged by the proportion of trials that settle
/// within the limit L, and has the bounds of this proportion: q_p ≤ L holds if the proportion is at least p.
/// The mean of the jerks has the bounds of cautious_bounds().
Judgement judge_requirement(const Requirement& requirement, const PointTrials& trials, double confidence,
                            double failing_confidence);

/// The sample by which a requirement is judged: one pair of numbers for each independent unit (trial, machine
/// or world).
struct RequirementSample {
  RequirementKind kind{RequirementKind::proportion};
  /// Limit of the requirement: for the mean, or for the proportion of trials.
  text::Limit limit{text::Relation::at_least, 0.0};
  bool clustered{false};  ///< True: the independent units are machines or worlds. False: single trials.
  /// [unit] Number of the unit's trials (for a goal: moves) that satisfy the requirement; for a mean, the
  /// value of the unit.
  std::vector<double> hits{};
  std::vector<double> events{};  ///< [unit] Number of the unit's trials (for a goal: moves); 1 for a mean.
};
RequirementSample requirement_sample(const Requirement& requirement, const PointTrials& trials);

/// The terms 1, h, e, h², h·e, e² of an independent unit with h hits in e events. The verdict on a
/// requirement depends on the sums of these terms over the units.
two_samples::Sums sums_of_unit(double hits, double events);

/// The verdict of judge_requirement() from sums alone.
/// @param sample the requirement; its values are not used
/// @param sums sums_of_unit() summed over the units
/// @param confidence, failing_confidence as for judge_requirement()
GateVerdict requirement_verdict(const RequirementSample& sample, const two_samples::Sums& sums,
                                double confidence, double failing_confidence);

/// The confidence 1 − (1 − confidence)/count with which each of `count` requirements must be contradicted.
/// Then, with the probability `confidence`, no requirement that is in truth met fails (Bonferroni).
double failing_confidence(double confidence, std::int64_t count);

}  // namespace zerocount::comparison
