#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/point_trials.hpp"

namespace zerocount::comparison {

/// Minimum number of values in each file for the comparison of a mean. If fewer trials arrive, the proportion
/// of arrivals shows the difference.
inline constexpr std::int64_t min_values = 20;

/// The measures that are judged at a point with these trials.
std::vector<GateMeasure> judged_measures(const GateRules& rules, const PointTrials& trials);

/// Tests all judged measures at one point. The verdicts follow in decide(), which controls the false
/// discoveries over all points.
/// @param paired whether trial i of both drew the same random numbers; both then have the same number of
/// trials
std::vector<MeasureComparison> compare_measures(const GateRules& rules, const std::string& label,
                                                const PointTrials& baseline, const PointTrials& current,
                                                bool paired);

/// The values of one measure at one point that are judged: a value for each independent unit, which is a
/// trial, or a rig where trials share rigs.
struct MeasureSample {
  bool proportion{false};        ///< values of 0 and 1 (1: failed), compared by the tests of proportions
  bool paired{false};            ///< unit i of both drew the same random numbers
  double plausible{1.0};         ///< plausible difference of a single unit, the `unit` of cautious_bounds()
  std::vector<double> baseline;  ///< [unit] larger is worse; NaN where the unit has no value
  std::vector<double> current;   ///< [unit]
};

/// The samples behind the results of compare_measures() with the same arguments, in the same order.
/// @param found these results; a quantile's sample follows from its effect and bounds
std::vector<MeasureSample> measure_samples(const GateRules& rules, std::span<const MeasureComparison> found,
                                           const PointTrials& baseline, const PointTrials& current,
                                           bool paired);

/// Whether the measure was tested, with bounds that a forecast can start from.
bool has_finite_bounds(const TestedMeasure& measure);

/// The standard error of a normal distribution with these one-sided bounds.
double standard_error_of(const statistics::ConfidenceInterval& bounds, double confidence);

/// Adjusts the p-values of all measures of a comparison, and finds the verdict on the change of each.
/// @param rate of false discoveries
void decide(std::span<TestedMeasure> tested, double rate);

/// Gives every measure its adjusted p-values and its verdicts.
///
/// A measure is worse where its adjusted p is at most the rate and its effect exceeds the margin, better
/// where the same holds for the opposite direction. It is equivalent where both bounds of its effect are
/// within the margin (two one-sided tests: Schuirmann, Journal of Pharmacokinetics and Biopharmaceutics 15
/// (1987), 657), and not worse where only the upper bound is below it. Worse fails the gate; the others pass,
/// except undecided. Where every change fails, better fails too, and only equivalent passes.
/// @return the number of tests over which the false discoveries were controlled.
std::int64_t decide(std::span<PointComparison> points, const GateRules& rules);

/// The smallest true change for the worse that is found with decision_probability: with s its standard error,
/// M the margin and α the strictest level of the adjustment over m tests, that of a change of one measure
/// alone, the solution of
///
///   δ = max(M + z_0.8·s, (z_{1−α} + z_0.8)·s),   α = rate/(m·(1 + ½ + … + 1/m)),
///
/// α/2 where every change fails. s is that of the bounds; with n pairs of a proportion s² + δ/n, because the
/// change makes pairs differ. A normal approximation, which leaves the rank tests out.
/// @param tests m
double detectable_change(const MeasureComparison& measure, const GateRules& rules, std::size_t tests);

/// The verdict of the gate on a change.
GateVerdict gate_verdict(ChangeVerdict change, bool changed_fails);

/// The worst of several verdicts, in the order of GateVerdict; not_measured where all are.
GateVerdict worst_of(std::span<const GateVerdict> verdicts);

/// Adjusted p-values that control the false discovery rate whatever the dependence between the tests: with
/// p_(1) ≤ … ≤ p_(m) and H_m = 1 + 1/2 + … + 1/m,
///
///   q_(i) = min over j ≥ i of min(1, m·H_m·p_(j)/j).
///
/// Rejecting where q ≤ α has an expected proportion of false rejections of at most α. Where every null
/// hypothesis is true, that is the probability of any rejection at all. Source: Benjamini and Yekutieli,
/// Annals of Statistics 29 (2001), 1165, Theorem 1.3.
///
/// @param p in [0, 1], any order; @return in the same order.
std::vector<double> benjamini_yekutieli(std::span<const double> p);

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

/// The numbers of each independent unit that a requirement judges, which is a trial, or a rig where trials
/// share rigs.
struct RequirementSample {
  RequirementKind kind{RequirementKind::proportion};
  bool at_least{true};
  double limit{0.0};      ///< of the mean, or of the proportion of trials
  bool clustered{false};  ///< the units are rigs
  std::vector<double>
      hits;  ///< [unit] trials that meet the requirement by themselves; or the value of a mean
  std::vector<double> events;  ///< [unit] trials; 1 of a mean
};
RequirementSample requirement_sample(const Requirement& requirement, const PointTrials& trials);

/// Sums over the units of a sample: their number, of their hits and events, and of the products of these.
struct RequirementSums {
  double units{0.0};
  double hits{0.0};
  double events{0.0};
  double hits_squared{0.0};
  double hits_by_events{0.0};
  double events_squared{0.0};
};

/// The verdict of judge_requirement() on a sample with these sums.
GateVerdict requirement_verdict(const RequirementSample& sample, const RequirementSums& sums,
                                double confidence, double failing_confidence);

/// The confidence with which each of `count` requirements must be contradicted, so that with this confidence
/// none of those that are met fails (Bonferroni): 1 − (1 − confidence)/count.
double failing_confidence(double confidence, std::int64_t count);

}  // namespace zerocount::comparison
