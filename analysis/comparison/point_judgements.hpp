#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/comparison/judgement.hpp"
#include "analysis/comparison/point_trials.hpp"
#include "analysis/two_samples/continued_sample.hpp"

/// The judgements on the trials of one design point: the values of the independent units, which are trials,
/// or machines or worlds where trials share these, and the tests of these values.
namespace zerocount::comparison {

/// Minimum number of values in each file for the comparison of a mean. If fewer trials arrive, the proportion
/// of arrivals shows the difference.
inline constexpr std::int64_t min_values = 20;

/// The trials of a point in both files.
struct BothTrials {
  const PointTrials& baseline;
  const PointTrials& current;
  bool paired{false};  ///< trial i of both drew the same random numbers; both then have as many trials
};

/// The measures that are judged at a point with these trials.
std::vector<GateMeasure> judged_measures(const GateRules& rules, const PointTrials& trials);

/// Tests all judged measures at one point. The verdicts follow in decide(), which controls the false
/// discoveries over all points.
std::vector<Judgement> compare_measures(const GateRules& rules, const std::string& label,
                                        const BothTrials& trials);

/// The samples behind the results of compare_measures() with the same arguments, in the same order.
/// @param found these results; a quantile's sample follows from its effect and bounds
std::vector<two_samples::Sample> measure_samples(const GateRules& rules, std::span<const Judgement> found,
                                                 const BothTrials& trials);

/// Judges a requirement at one point by one-sided bounds: it passes where the bound against the limit, at
/// `confidence`, meets it; it fails where the other bound, at `failing_confidence`, contradicts it; otherwise
/// it is inconclusive.
///
/// Proportions have Clopper–Pearson bounds. A quantile of the settling time of a trial (that of its slowest
/// move; infinite if a move did not arrive) is judged as the proportion of trials that settle within the
/// limit L: q_p ≤ L holds if that proportion is at least p. Its bounds are those of this proportion. The mean
/// of the jerks has the bounds of cautious_bounds().
Judgement judge_requirement(const Requirement& requirement, const PointTrials& trials, double confidence,
                            double failing_confidence);

/// The numbers of each independent unit that a requirement judges.
struct RequirementSample {
  RequirementKind kind{RequirementKind::proportion};
  bool at_least{true};
  double limit{0.0};      ///< of the mean, or of the proportion of trials
  bool clustered{false};  ///< the units are machines
  /// [unit] trials that meet the requirement by themselves; or the value of a mean
  std::vector<double> hits{};
  std::vector<double> events{};  ///< [unit] trials; 1 of a mean
};
RequirementSample requirement_sample(const Requirement& requirement, const PointTrials& trials);

/// The terms 1, h, e, h², h·e, e² of a unit with h hits in e events. The verdict needs their sums over the
/// units.
two_samples::Sums sums_of_unit(double hits, double events);

/// The verdict of judge_requirement() on a sample with these sums.
GateVerdict requirement_verdict(const RequirementSample& sample, const two_samples::Sums& sums,
                                double confidence, double failing_confidence);

/// The confidence with which each of `count` requirements must be contradicted, so that with this confidence
/// none of those that are met fails (Bonferroni): 1 − (1 − confidence)/count.
double failing_confidence(double confidence, std::int64_t count);

}  // namespace zerocount::comparison
