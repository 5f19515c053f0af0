#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/statistics/unknown.hpp"
#include "analysis/two_samples/sample.hpp"

/// The judgements of a comparison at a design point, and the rules by which numbers give a verdict.
namespace zerocount::comparison {

/// Probability with which the number of trials that would decide does decide, and with which the smallest
/// detectable change is found.
inline constexpr double decision_probability = 0.8;

/// The gate's verdict on a measure, a requirement, a point or the whole comparison; the worst first.
enum class GateVerdict {
  regression,    ///< shown: worse by more than the margin, or the requirement is not met
  changed,       ///< shown: better by more than the margin, where every change fails
  inconclusive,  ///< neither a failure nor its absence is shown
  passed,        ///< shown: no worse (or no change) than the margin allows, or the requirement is met
  not_measured   ///< too few trials have a value; does not affect the other verdicts
};

/// The change of one measure that the data show. The gate's verdict follows from it. With e the effect and M
/// the margin:
enum class ChangeVerdict {
  worse,        ///< e > M is shown: by the adjusted p of e ≤ M, and by the lower bound
  better,       ///< e < −M is shown: by the adjusted p of e ≥ −M, and by the upper bound
  equivalent,   ///< −M < e < M: both one-sided bounds are within the margin
  not_worse,    ///< e < M only: better or equivalent, which of them is open
  undecided,    ///< none of these
  not_measured  ///< too few trials have a value
};

/// "passed", "regression", "changed", "inconclusive" or "not measured".
std::string_view to_string(GateVerdict verdict);
/// "worse", "better", "equivalent", "not worse", "undecided" or "not measured".
std::string_view to_string(ChangeVerdict change);

/// True for a verdict that fails the gate.
constexpr bool fails(GateVerdict verdict) {
  return verdict == GateVerdict::regression || verdict == GateVerdict::changed;
}

/// The verdict of the gate on a change.
GateVerdict gate_verdict(ChangeVerdict change, bool changed_fails);

/// The worst of several verdicts, in the order of GateVerdict; not_measured where all are.
GateVerdict worst_of(std::span<const GateVerdict> verdicts);

/// The numbers of one measure that its verdict follows from.
struct TestedMeasure : two_samples::Change {
  double margin{statistics::unknown};      ///< largest accepted effect
  bool changed_fails{false};               ///< a change for the better beyond the margin fails too
  double adjusted_p{statistics::unknown};  ///< beyond.worse after control of the false discoveries
  double adjusted_improvement_p{statistics::unknown};  ///< beyond.better after it
  ChangeVerdict change{ChangeVerdict::not_measured};
};

/// A measure at a design point in the two files, or an absolute requirement on a quantity of the current one.
struct Judgement : TestedMeasure {
  std::string measure{};       ///< of gate_measures(); of a requirement its quantity, "arrival_time.p95"
  std::string unit{};          ///< of every value here
  std::string requirement{};   ///< as it was given, "success_rate ≥ 0.995"; empty of a measure
  bool at_least{true};         ///< of a requirement, whose limit is `margin`: ≥; otherwise ≤
  std::string test{};          ///< that gave p
  std::int64_t baseline_n{0};  ///< trials with a value
  std::int64_t current_n{0};   ///< likewise; the number of pairs in both where they are paired
  double baseline{statistics::unknown};  ///< proportion, mean or quantile
  double current{statistics::unknown};
  /// Smallest true change for the worse that these trials find with decision_probability; README.md.
  double detectable_change{statistics::unknown};
  bool paired_proportion{false};                   ///< the trials of a proportion were compared one by one
  GateVerdict verdict{GateVerdict::not_measured};  ///< of the gate
  /// Trials per design point that decide what is inconclusive, with decision_probability.
  std::optional<double> trials_to_decide{};
  double decided_margin{statistics::unknown};  ///< of an inconclusive measure: any larger one is decided now
  double max_trials_margin{statistics::unknown};  ///< where no number of trials decides: the smallest margin
                                                  ///< that max_trials_to_decide do
  std::string note{};                             ///< reason or remark; may be empty

  bool is_measure() const { return requirement.empty(); }
  bool is_open() const { return verdict == GateVerdict::inconclusive; }
};

/// Whether the measure was tested, with bounds that a forecast can start from.
bool has_finite_bounds(const TestedMeasure& measure);

/// The standard error of a normal distribution with these one-sided bounds.
double standard_error_of(const statistics::ConfidenceInterval& bounds, double confidence);

/// The largest change that its bounds leave possible, of those that fail: any larger margin is decided.
double largest_possible_change(const TestedMeasure& measure);

/// Adjusts the p-values of all measures of a comparison, and finds the verdict on the change of each.
/// @param rate of false discoveries
void decide(std::span<TestedMeasure> tested, double rate);

/// Gives every measure its adjusted p-values and its verdicts.
///
/// A measure is worse where a change of no more than the margin is rejected: where its adjusted p is at most
/// the rate, and the lower bound exceeds the margin. An estimate beyond the margin shows nothing by itself.
/// It is better where the same holds for the opposite direction. It is equivalent where both bounds of its
/// effect are within the margin (two one-sided tests: Schuirmann, Journal of Pharmacokinetics and
/// Biopharmaceutics 15 (1987), 657), and not worse where only the upper bound is below it. Worse fails the
/// gate; the others pass, except undecided. Where every change fails, better fails too, and only equivalent
/// passes.
/// @param measures of all points
/// @return the number of tests over which the false discoveries were controlled.
std::int64_t decide(std::span<Judgement* const> measures, const GateRules& rules);

/// The smallest true change for the worse that is found with decision_probability: with s its standard error,
/// M the margin and α the strictest level of the adjustment over m tests, that of a change of one measure
/// alone, the solution of
///
///   δ = M + (z_{1−α} + z_0.8)·s,   α = rate/(m·(1 + ½ + … + 1/m)),
///
/// α/2 where every change fails. s is that of the bounds; with n pairs of a proportion s² + δ/n, because the
/// change makes pairs differ. A normal approximation, which leaves the rank tests out.
/// @param tests m
double detectable_change(const Judgement& measure, const GateRules& rules, std::size_t tests);

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

}  // namespace zerocount::comparison
