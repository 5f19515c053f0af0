#pragma once

#include <cstddef>
#include <cstdint>

namespace zerocount::statistics {

/// A closed confidence interval [low, high].
struct ConfidenceInterval {
  double low{0.0};
  double high{0.0};

  double half_width() const { return 0.5 * (high - low); }
};

/// Default confidence level of bounds, used for every answer that is not asked for another, and for all
/// bounds in a results file.
inline constexpr double summary_confidence = 0.95;

/// Checks that a probability lies between 0 and 1.
/// @throws Failure (bad_input) unless 0 < value < 1; `what` names it in the message.
void require_open_unit(const char* what, double value);
inline void require_confidence(double confidence) {
  require_open_unit("confidence", confidence);
}

/// Confidence that each of m statements needs so that all of them hold together with the confidence γ: 1 − (1
/// − γ)/m (Bonferroni).
double confidence_of_each(double confidence, std::size_t statements);

/// Divergence KL(y‖q) = y·ln(y/q) + (1 − y)·ln((1 − y)/(1 − q)) of two Bernoulli distributions.
double bernoulli_divergence(double y, double q);

/// Observed proportion successes/trials; NaN if trials is 0.
double rate(std::int64_t successes, std::int64_t trials);

/// One-sided Clopper–Pearson bounds of a proportion. Lower: the p for which `successes` or more of `trials`
/// have the probability `tail`. Upper (next function): the p for which `successes` or fewer have it. The
/// numbers need not be whole; 0 < successes for the lower bound, successes < trials for the upper. Up to 10¹³
/// trials accurate to a thousandth of the standard error.
double lower_bound_on_p(double successes, double trials, double tail);
double upper_bound_on_p(double successes, double trials, double tail);

/// Clopper–Pearson interval of a proportion: the p that neither one-sided binomial test at (1 − confidence)/2
/// rejects.
///
/// The coverage is at least the stated probability for every true proportion. low is 0 if successes = 0, high
/// is 1 if successes = trials, and the interval is [0, 1] if trials = 0. Source: Clopper and Pearson (1934).
ConfidenceInterval clopper_pearson(std::int64_t successes, std::int64_t trials,
                                   double confidence = summary_confidence);

/// The one-sided lower Clopper–Pearson bound of a proportion: the p for which `successes` or more of `trials`
/// have the probability 1 − confidence. 0 if successes = 0.
///
/// It gives the tolerance statement of Wilks (1941),
/// "at least the proportion p of all succeed". Without a failure p = (1 − confidence)^(1/n), so the failures
/// are at most 1 − p ≈ −ln(1 − confidence)/n: 3/n at 95 % (the rule of three; Hanley and Lippman-Hand 1983).
double proportion_at_least(std::int64_t successes, std::int64_t trials, double confidence);

/// The one-sided upper Clopper–Pearson bound of a proportion: 1 − proportion_at_least(failures), computed
/// without cancellation where it is small.
double proportion_at_most(std::int64_t successes, std::int64_t trials, double confidence);

/// Wilson score interval of a proportion: with z the normal quantile of (1 + confidence)/2 and p = k/n,
///
///   (p + z²/2n ± z·√(p(1 − p)/n + z²/4n²)) / (1 + z²/n).
///
/// Shorter than Clopper–Pearson, but has the stated coverage only on average. The same edge cases: exactly 0,
/// 1 and [0, 1]. Source: Wilson (1927).
ConfidenceInterval wilson(std::int64_t successes, std::int64_t trials,
                          double confidence = summary_confidence);

/// The Wilson score interval (see wilson()) for an observed proportion p of n independent events. n > 0 need
/// not be whole.
/// @param z normal quantile of (1 + confidence)/2
ConfidenceInterval wilson_interval(double p, double n, double z);

}  // namespace zerocount::statistics
