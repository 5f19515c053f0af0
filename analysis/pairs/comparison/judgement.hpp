#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/pairs/two_samples/sample.hpp"

/// The judgements of a comparison at a design point, and the rules that turn numbers into verdicts.
namespace zerocount::comparison {

/// Probability with which the forecast number of trials decides, and with which the smallest detectable
/// change is found.
inline constexpr double decision_probability = 0.8;

/// Verdict of the gate (the pass/fail check of a comparison) on a measure, a requirement, a point or the
/// whole comparison; the worst first.
enum class GateVerdict {
  /// The data show a failure: a change for the worse beyond the margin, or a requirement that is not met.
  regression,
  /// The data show a change for the better beyond the margin, and the rules say that every change fails.
  changed,
  inconclusive,  ///< The data show neither a failure nor that there is none.
  /// The data show that no change that would fail exceeds the margin, or that the requirement is met.
  passed,
  not_measured  ///< Too few trials have a value; the verdict on the whole comparison does not depend on it.
};

/// The change of one measure that the data show. It determines the gate's verdict. e is the effect (positive:
/// for the worse) and M the margin.
enum class ChangeVerdict {
  /// Effect e > M is shown, a change for the worse beyond the margin M: by the adjusted p of e ≤ M, and by
  /// the lower bound of e.
  worse,
  /// Effect e < −M is shown, a change for the better beyond the margin M: by the adjusted p of e ≥ −M, and by
  /// the upper bound of e.
  better,
  /// −M < e < M is shown, a change within the margin M: both one-sided bounds of e are within it.
  equivalent,
  /// Only e < M is shown: the measure is better or equivalent, but not worse by more than the margin M.
  not_worse,
  undecided,    ///< None of the other changes is shown.
  not_measured  ///< Too few trials have a value for a test.
};

/// Text of a verdict: "passed", "regression", "changed", "inconclusive" or "not measured".
std::string_view to_string(GateVerdict verdict);
/// Text of a change: "worse", "better", "equivalent", "not worse", "undecided" or "not measured".
std::string_view to_string(ChangeVerdict change);

/// Whether the verdict fails the gate: regression or changed.
constexpr bool fails(GateVerdict verdict) {
  return verdict == GateVerdict::regression || verdict == GateVerdict::changed;
}

/// The gate's verdict that follows from a shown change of a measure.
/// @param changed_fails whether a change for the better fails too
GateVerdict gate_verdict(ChangeVerdict change, bool changed_fails);

/// The worst of several verdicts, in the order of GateVerdict; not_measured if all are not_measured.
GateVerdict worst_of(std::span<const GateVerdict> verdicts);

/// The change of one measure between the two files, with the numbers that determine its verdict.
struct TestedMeasure : two_samples::Change {
  /// Largest effect (change for the worse) that is accepted, in the measure's unit.
  double margin{statistics::unknown};
  bool changed_fails{false};  ///< True: a change for the better beyond the margin fails the gate, too.
  /// p-value of the hypothesis that the measure is not worse by more than the margin (beyond.worse), adjusted
  /// for false discoveries.
  double adjusted_p{statistics::unknown};
  /// p-value of the hypothesis that the measure is not better by more than the margin (beyond.better),
  /// adjusted for false discoveries.
  double adjusted_improvement_p{statistics::unknown};
  ChangeVerdict change{ChangeVerdict::not_measured};
};

/// The judgement of a measure at a design point by comparing the two files, or of an absolute requirement on
/// a quantity of the current file alone. For a requirement, `margin` is its limit.
struct Judgement : TestedMeasure {
  /// Name of the measure in gate_measures(); for a requirement the name of its quantity, "arrival_time.p95".
  std::string measure{};
  std::string unit{};         ///< Unit of the values, effects, bounds and margins of the judgement.
  std::string requirement{};  ///< Text of the requirement, "success_rate ≥ 0.995"; empty for a measure.
  /// Relation that a requirement demands between the quantity and its limit: at least (≥) or at most (≤).
  text::Relation relation{text::Relation::at_least};
  std::string test{};  ///< Name of the statistical test that gave the p-values.
  /// Number of trials of the baseline with a value; if trials are paired, number of pairs.
  std::int64_t baseline_n{0};
  /// Number of trials of the current file with a value; if trials are paired, number of pairs.
  std::int64_t current_n{0};
  /// Value of the baseline: the proportion, mean or quantile that is compared.
  double baseline{statistics::unknown};
  /// Value of the current file: the proportion, mean or quantile that is compared.
  double current{statistics::unknown};
  /// Smallest true change for the worse that a study with these trials finds with probability
  /// decision_probability (detectable_change()), in the measure's unit.
  double detectable_change{statistics::unknown};
  /// True: the measure is a proportion, and its trials were compared one by one.
  bool paired_proportion{false};
  GateVerdict verdict{GateVerdict::not_measured};  ///< The gate's verdict on this measure or requirement.
  /// For an inconclusive judgement: number of trials per design point that decides it with probability
  /// decision_probability. Null if no tried number does.
  std::optional<double> trials_to_decide{};
  /// For an inconclusive measure: smallest margin, in its unit. The present trials would decide any margin
  /// larger than this.
  double decided_margin{statistics::unknown};
  /// If no tried number of trials decides the measure: the smallest margin that
  /// StudyComparison::max_trials_to_decide trials decide. Otherwise unknown (NaN).
  double max_trials_margin{statistics::unknown};
  std::string note{};  ///< Reason for the verdict, or another remark; may be empty.

  bool is_measure() const { return requirement.empty(); }
  bool is_open() const { return verdict == GateVerdict::inconclusive; }
};

/// Whether the measure was tested and both bounds of its change are finite. A forecast starts from such
/// bounds.
bool has_finite_bounds(const TestedMeasure& measure);

/// The standard error of a normally distributed estimate with these one-sided bounds.
/// @param confidence confidence of each bound
double standard_error_of(const statistics::ConfidenceInterval& bounds, double confidence);

/// The largest change, among those that would fail the gate, that is still possible by the bounds of the
/// measure. If the margin were larger than this, the measure would be decided.
double largest_possible_change(const TestedMeasure& measure);

/// Adjusts the p-values of all measures of a comparison for false discoveries, and sets the shown change of
/// each.
/// @param rate accepted false discovery rate
void decide(std::span<TestedMeasure> tested, double rate);

/// Gives every measure of a comparison its adjusted p-values and its verdicts.
///
/// A measure is worse if the hypothesis of a change within the margin is rejected: its adjusted p is at most
/// the accepted false discovery rate, and the lower bound of the effect exceeds the margin. An estimate
/// beyond the margin shows nothing by itself. A measure is better if both hold for the opposite direction. It
/// is equivalent if both bounds of its effect are within the margin (two one-sided tests: Schuirmann, Journal
/// of Pharmacokinetics and Biopharmaceutics 15 (1987), 657), and not worse if only the upper bound is below
/// the margin. Worse fails the gate; better, equivalent and not worse pass. If the rules say that every
/// change fails, better fails too, and only equivalent passes.
/// @param measures measures of all points
/// @return number of tests over which the false discovery rate was controlled
std::int64_t decide(std::span<Judgement* const> measures, const GateRules& rules);

/// The smallest true change δ for the worse that is found with decision_probability, the solution of
///
///   δ = M + (z_{1−α} + z_0.8)·s,   α = rate/(m·(1 + ½ + … + 1/m)).
///
/// M is the margin and s the standard error that follows from the bounds. α is the strictest level of the
/// adjustment over m tests, which applies if only one measure changes; it is halved if every change fails.
/// For a proportion of n pairs s² is replaced by s² + δ/n, because the change makes pairs differ. The formula
/// is a normal approximation that ignores the rank tests. NaN without finite bounds.
/// @param tests number m of tests
double detectable_change(const Judgement& measure, const GateRules& rules, std::size_t tests);

/// Adjusted p-values that control the false discovery rate whatever the dependence between the tests: with
/// p_(1) ≤ … ≤ p_(m) and H_m = 1 + 1/2 + … + 1/m,
///
///   q_(i) = min over j ≥ i of min(1, m·H_m·p_(j)/j).
///
/// If hypotheses with q ≤ α are rejected, the expected proportion of false rejections is at most α. If every
/// null hypothesis is true, α bounds the probability of any rejection at all. Source: Benjamini and
/// Yekutieli, Annals of Statistics 29 (2001), 1165, Theorem 1.3.
///
/// @param p p-values in [0, 1], in any order;
/// @return the adjusted p-values in the same order
std::vector<double> benjamini_yekutieli(std::span<const double> p);

}  // namespace zerocount::comparison
