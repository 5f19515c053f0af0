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

/// The judgements of a comparison at a design point, and the rules that turn numbers into verdicts.
namespace zerocount::comparison {

/// Probability with which the forecast number of trials decides, and with which the smallest detectable
/// change is found.
inline constexpr double decision_probability = 0.8;

/// The gate's verdict on a measure, a requirement, a point or the whole comparison; the worst first.
enum class GateVerdict {
  regression,    ///< Shown: worse by more than the margin, or the requirement is not met.
  changed,       ///< Shown: better by more than the margin, and every change fails.
  inconclusive,  ///< Neither a failure nor its absence is shown.
  passed,        ///< Shown: no failing change exceeds the margin, or the requirement is met.
  not_measured   ///< Too few trials have a value; does not affect the other verdicts.
};

/// The change of one measure that the data show. It determines the gate's verdict. e is the effect (positive:
/// for the worse) and M the margin.
enum class ChangeVerdict {
  worse,        ///< e > M is shown: by the adjusted p of e ≤ M, and by the lower bound
  better,       ///< e < −M is shown: by the adjusted p of e ≥ −M, and by the upper bound
  equivalent,   ///< −M < e < M: both one-sided bounds are within the margin
  not_worse,    ///< only e < M is shown: the measure is better or equivalent
  undecided,    ///< none of the changes above is shown
  not_measured  ///< too few trials have a value
};

/// "passed", "regression", "changed", "inconclusive" or "not measured".
std::string_view to_string(GateVerdict verdict);
/// "worse", "better", "equivalent", "not worse", "undecided" or "not measured".
std::string_view to_string(ChangeVerdict change);

/// Whether the verdict fails the gate.
constexpr bool fails(GateVerdict verdict) {
  return verdict == GateVerdict::regression || verdict == GateVerdict::changed;
}

/// The gate's verdict on a change. @param changed_fails whether a change for the better fails too
GateVerdict gate_verdict(ChangeVerdict change, bool changed_fails);

/// The worst of several verdicts, in the order of GateVerdict; not_measured if all are not_measured.
GateVerdict worst_of(std::span<const GateVerdict> verdicts);

/// The numbers of one measure that determine its verdict.
struct TestedMeasure : two_samples::Change {
  double margin{statistics::unknown};      ///< largest accepted effect
  bool changed_fails{false};               ///< A change for the better beyond the margin fails too.
  double adjusted_p{statistics::unknown};  ///< beyond.worse, adjusted for false discoveries
  double adjusted_improvement_p{statistics::unknown};  ///< beyond.better, adjusted for false discoveries
  ChangeVerdict change{ChangeVerdict::not_measured};
};

/// The judgement of a measure at a design point in the two files, or of an absolute requirement on a quantity
/// of the current file. For a requirement, `margin` is its limit.
struct Judgement : TestedMeasure {
  std::string measure{};  ///< Name in gate_measures(); for a requirement the quantity, "arrival_time.p95".
  std::string unit{};     ///< Unit of every value of the judgement.
  std::string requirement{};   ///< Text of the requirement, "success_rate ≥ 0.995"; empty for a measure.
  bool at_least{true};         ///< Sign of a requirement: ≥ if true, otherwise ≤.
  std::string test{};          ///< Name of the test that gave p.
  std::int64_t baseline_n{0};  ///< Number of trials of the baseline with a value; if paired, number of pairs.
  std::int64_t current_n{0};   ///< Number of trials of the current file with a value; if paired, of pairs.
  double baseline{statistics::unknown};  ///< proportion, mean or quantile of the baseline
  double current{statistics::unknown};   ///< proportion, mean or quantile of the current file
  /// Smallest true change for the worse that these trials find with decision_probability
  /// (detectable_change()).
  double detectable_change{statistics::unknown};
  bool paired_proportion{false};                   ///< The trials of a proportion were compared one by one.
  GateVerdict verdict{GateVerdict::not_measured};  ///< The gate's verdict.
  /// Trials per design point that decide an inconclusive judgement with decision_probability.
  std::optional<double> trials_to_decide{};
  /// For an inconclusive measure: the present trials decide any margin larger than this.
  double decided_margin{statistics::unknown};
  /// Set if no number of trials decides: the smallest margin that max_trials_to_decide trials decide.
  double max_trials_margin{statistics::unknown};
  std::string note{};  ///< reason or remark; may be empty

  bool is_measure() const { return requirement.empty(); }
  bool is_open() const { return verdict == GateVerdict::inconclusive; }
};

/// Whether the measure was tested and both bounds of its change are finite. A forecast starts from such
/// bounds.
bool has_finite_bounds(const TestedMeasure& measure);

/// The standard error of a normal distribution with these one-sided bounds. @param confidence confidence of
/// each bound
double standard_error_of(const statistics::ConfidenceInterval& bounds, double confidence);

/// The largest failing change that the bounds of the measure leave possible. A margin larger than this is
/// decided.
double largest_possible_change(const TestedMeasure& measure);

/// Adjusts the p-values of all measures of a comparison, and sets the verdict on the change of each.
/// @param rate accepted rate of false discoveries
void decide(std::span<TestedMeasure> tested, double rate);

/// Gives every measure its adjusted p-values and its verdicts.
///
/// A measure is worse if the hypothesis of a change within the margin is rejected: its adjusted p is at most
/// the rate, and the lower bound exceeds the margin. An estimate beyond the margin shows nothing by itself. A
/// measure is better if both hold for the opposite direction. It is equivalent if both bounds of its effect
/// are within the margin (two one-sided tests: Schuirmann, Journal of Pharmacokinetics and Biopharmaceutics
/// 15 (1987), 657), and not worse if only the upper bound is below the margin. Worse fails the gate; better,
/// equivalent and not worse pass. If every change fails, better fails too, and only equivalent passes.
/// @param measures measures of all points
/// @return number of tests over which the false discoveries were controlled
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
/// @param p p-values in [0, 1], in any order; @return the adjusted p-values in the same order
std::vector<double> benjamini_yekutieli(std::span<const double> p);

}  // namespace zerocount::comparison
