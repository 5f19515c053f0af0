#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::sensitivity {

/// A number with its confidence bounds; NaN where the number or a bound is not known.
struct BoundedNumber {
  double value{statistics::unknown};
  double low{statistics::unknown};
  double high{statistics::unknown};
};

/// Whether the bounds exclude all numbers from −limit to limit; false if the number has no bounds.
inline bool excludes_up_to(double limit, const BoundedNumber& number) {
  return number.low > limit || number.high < -limit;
}

/// Limits the estimate of a proportion, such as a Sobol' index, and its bounds to [0, 1]. If the estimate is
/// outside, it becomes 0 or 1, and the bound on the other side moves with it (by the same amount if the
/// estimate is below 0, in proportion if it is above 1). So the bounds never exclude all possible values nor
/// shrink to a point, and cover the true value at least as often as those given.
inline BoundedNumber clamped_index(BoundedNumber number) {
  if (std::isnan(number.value)) return {};
  number.low = std::min(number.low, number.value);
  number.high = std::max(number.high, number.value);
  if (number.value > 1.0) number.low /= number.value;
  if (number.value < 0.0) number.high -= number.value;
  return {std::clamp(number.value, 0.0, 1.0), std::clamp(number.low, 0.0, 1.0),
          std::clamp(number.high, 0.0, 1.0)};
}

// By how much two columns of independent pairs differ, as a proportion of what independent numbers would:
// D = Σ (x_r − y_r)²/(2N V), V the variance (divisor 2N) of all 2N numbers. The total index is D of A and
// C_j, and D of B and C_j is 1 less the first-order index without a control variate. Dimensionless; all
// bounds are NaN where V is 0.

/// Numbers of pairs of yes-or-no values, by agreement: both yes, different, both no.
struct AnswerPairs {
  std::int64_t both_yes{0};
  std::int64_t different{0};
  std::int64_t both_no{0};
};

/// Numbers of pairs (x[r], y[r]) by their values: both 1, different, both 0.
/// @param x, y of the same length; each value is 0 or 1
inline AnswerPairs answer_pairs(std::span<const double> x, std::span<const double> y) {
  AnswerPairs pairs;
  for (std::size_t r = 0; r < x.size(); ++r) {
    if (x[r] != y[r]) {
      ++pairs.different;
    } else {
      ++(x[r] == 1.0 ? pairs.both_yes : pairs.both_no);
    }
  }
  return pairs;
}

/// Estimates D = 1 − r from pairs of yes-or-no answers of a saltelli design, r the correlation within the
/// pairs; D and 1 − D give its Sobol' indices. With u the proportion of different pairs among those with a
/// yes in them and v among those with a no,
///
///   D = u/(2 − u) + v/(2 − v),
///
/// where u and v are proportions of independent pairs with bounds of Clopper and Pearson. The bounds of the
/// sum follow from those of its terms by the method of variance estimates recovery (Zou & Donner, Stat. Med.
/// 27, 2008), with the correlation √((1 − u)(1 − v)) of the logits of u and v. 1 − D is the intraclass kappa
/// of two raters (Donner & Eliasziw, Stat. Med. 11, 1992).
///
/// Without a different pair, the lower bound is 0 and the upper one about 3.7/(2N V) at 95 %. With one, the
/// lower bound is above 0.
inline BoundedNumber yes_no_difference(const AnswerPairs& pairs, double confidence) {
  const std::int64_t with_yes = pairs.both_yes + pairs.different;
  const std::int64_t with_no = pairs.both_no + pairs.different;
  if (with_yes == 0 || with_no == 0) return {};
  const auto part = [](double proportion) { return proportion / (2.0 - proportion); };
  const double u = statistics::rate(pairs.different, with_yes);
  const double v = statistics::rate(pairs.different, with_no);
  const statistics::ConfidenceInterval of_u =
      statistics::clopper_pearson(pairs.different, with_yes, confidence);
  const statistics::ConfidenceInterval of_v =
      statistics::clopper_pearson(pairs.different, with_no, confidence);
  const double correlation = std::sqrt((1.0 - u) * (1.0 - v));
  const auto together = [&](double a, double b) {
    return std::sqrt(a * a + b * b + 2.0 * correlation * a * b);
  };
  const double value = part(u) + part(v);
  // The triangle inequality leaves low at part(low of u) + part(low of v) at least; rounding must not.
  const double low = value - together(part(u) - part(of_u.low), part(v) - part(of_v.low));
  const double high = value + together(part(of_u.high) - part(u), part(of_v.high) - part(v));
  return {value, std::max(low, part(of_u.low) + part(of_v.low)), high};
}

/// Upper bound of the proportion of an output's variance that may come from events too rare to occur among
/// the rows of a saltelli design. An event that was not seen in N rows has at most the probability −ln(δ)/N
/// with the confidence 1 − δ, δ = (1 − confidence)/2 (Poisson; at 95 % 3.7/N). It is taken to change the
/// output as much as independent trials that differ do on average. Such trials have the mean square
/// difference 2V, so the proportion is −ln(δ)/m, where m is the number of rows in which A and B differ; at
/// most 1.
inline double unseen_index(std::span<const double> a, std::span<const double> b, double confidence) {
  double different = 0.0;
  for (std::size_t r = 0; r < a.size(); ++r) different += a[r] != b[r] ? 1.0 : 0.0;
  const double events = -std::log(0.5 * (1.0 - confidence));
  return events < different ? events / different : 1.0;
}

/// Widens bounds from resampling by `unseen`, the proportion of the variance from events too rare to be among
/// the rows. It is an independent contribution, added by the method of variance estimates recovery.
inline BoundedNumber with_unseen(const BoundedNumber& resampled, double unseen) {
  const double value = resampled.value;
  const double below = std::fmax(0.0, value - resampled.low);
  const double above = std::fmax(0.0, resampled.high - value);
  return {value, value - std::hypot(below, unseen), value + std::hypot(above, unseen)};
}

/// First-order Sobol' index of a factor from any sample of independent trials, the proportion of the variance
/// of y that the mean of y given x has:
///
///   S = 1 − E/V,   V the variance of y,   E the mean over all trials of the variance of y about m(x).
///
/// m is a straight line within each of K = ⌊n^(2/3)/2⌋ classes of neighbours in x with as many trials each
/// (values that are equal stay together); of at most K distinct values each is a class with its mean. The
/// variance of a class about m has the divisor trials − coefficients, so that what m follows by chance does
/// not count; a class without more trials than coefficients takes the mean of the others. For classes with
/// means only this is the correlation ratio (Pearson 1905) less its expectation (Kelley 1935), which counts
/// the slope within a class as noise, most in the tail of a skewed factor. With n^(2/3)/2 classes a step or a
/// kink of m is lost in less than the bounds.
///
/// The bounds are those of ln(E/V) ± t·s. With r² the square of a trial about m, by its class's divisor,
///
///   n²s² = Σ ψ² + 2(p − 1),   ψ = r²/E − (y − μ)²/V less its mean,
///
/// ψ the influence function and 2(p − 1) the variance that fitting p coefficients adds, by which S varies
/// where x has no influence. t is Student's quantile of (1 + confidence)/2 with e/2 − 1 degrees of freedom,
/// ½ at least, e = (Σψ²)²/Σψ⁴ being how many trials carry s: of skewed values the largest few, which tell
/// little of those not seen, so that the bounds may leave all open. The lower bound is at most that of
/// ln(E/V) + (χ² − (p − 1))/n, χ² the quantile with p − 1 degrees of freedom. Where it is not above 0, s is
/// too small because S is: the upper bound is then at least the larger h with, z the normal quantile,
///
///   (h − S)² = z²·[4h(1 − h)/n + 2(p − 1)/n²].
///
/// Value and bounds are held in [0, 1] (clamped_index). NaN where x or y is constant, or there are fewer than
/// 20 trials. x and y have the same length.
BoundedNumber given_data_first_order(std::span<const double> x, std::span<const double> y, double confidence);

/// Outputs of the trials of a saltelli design with k factors and N rows; all are finite (see
/// experiments/designs/designs.hpp).
struct SaltelliSample {
  std::vector<double> a;  ///< [row] Output of the trial whose factors are row r of the matrix A.
  /// [row] Output of the trial whose factors are row r of the matrix B, independent of A.
  std::vector<double> b;
  /// [factor][row] Output for row r of A with this factor's value taken from B.
  std::vector<std::vector<double>> c;
};

/// Sobol' indices of one factor, dimensionless.
struct SobolIndices {
  BoundedNumber first_order;
  BoundedNumber total;
};

/// Number of values that would make up the variance if each contributed the same amount (Kish's effective
/// number). For normal values it is a third of their number, for skewed values the largest few.
/// @param values finite
double values_behind_variance(std::span<const double> values);

/// Number of bootstrap replicates (resampled data sets) for bounds of this confidence: enough that 25 lie
/// beyond each bound, and at least 1000.
std::int64_t bootstrap_replicates(double confidence);

/// First-order and total Sobol' indices, [factor]. With m and V the mean and the variance (divisor 2N) of the
/// 2N numbers in the two columns named,
///
///   T_j = 1/(2N) Σ (a_r − c_jr)² / V(a, c_j)
///   S_j = [1/N Σ b_r·c_jr − m(b, c_j)² − λ_j·(1/N Σ a_r·b_r − 1/N² Σ a_r Σ b_r)] / V(b, c_j).
///
/// T_j is Jansen's (1999; Saltelli et al. 2010, table 2 (f)) with the variance of Janon, Klein, Lagnoux,
/// Nodet & Prieur (2014), by which 1 − T_j is a correlation. S_j is theirs, less a control variate whose
/// expectation is 0 because A and B are independent: with λ_j = 0 it is best where the factor is nearly all,
/// with λ_j = 1 that of Saltelli et al. (2010, table 2 (b)), best where it is nearly nothing. λ_j is the
/// regression coefficient of b·c_j − S_j(b² + c_j²)/2 on a·b, all less their means (Glynn & Szechtman 2002),
/// of the sample given. S_j is 0 where c_j is a. Values and bounds are held in [0, 1] (clamped_index).
///
/// For an output that is 0 or 1 throughout, the bounds of T_j are those of yes_no_difference. Those of S_j
/// are the wider of the percentiles and 1 less yes_no_difference of B and C_j. For any other output they are
/// percentiles of these numbers over samples of N rows that are drawn anew from the rows, with replacement
/// (Archer, Saltelli & Sobol' 1997), with unseen_index; of more than 4096 rows, 4096 groups of neighbouring
/// ones are drawn. Rows drawn anew never exceed the largest ones seen, so that percentiles alone hold too
/// rarely for skewed outputs: the bounds are at least value ± t·s,
///
///   N²s² = Σ ψ²,   t Student's quantile with e/2 − 1 degrees of freedom, ½ at least,   e = (Σψ²)²/Σψ⁴,
///
/// ψ the influence of a row on the index, and e how many rows carry s, as in given_data_first_order. The
/// upper bound of S_j is not above that of T_j, and the lower one of T_j is 0 only where no row differs. NaN
/// where A and B have no variance or there are fewer than two rows, and for a factor where A and C_j have
/// none. An output that is not a yes or no has no bounds where its variance comes from fewer than ten trials
/// of A and B: (Σ (y − m)²)²/Σ (y − m)⁴ < 20.
/// @param randomness random stream that selects the resampled rows; the same stream gives the same bounds.
std::vector<SobolIndices> saltelli_indices(const SaltelliSample& sample, double confidence,
                                           const random::RandomStream& randomness);

}  // namespace zerocount::sensitivity
