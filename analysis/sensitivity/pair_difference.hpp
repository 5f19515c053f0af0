#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "analysis/sensitivity/bounded_number.hpp"
#include "analysis/statistics/proportion.hpp"

/// By how much two columns of independent pairs differ, as a proportion of what independent numbers would:
/// D = Σ (x_r − y_r)²/(2N V), V the variance (divisor 2N) of all 2N numbers. The total index is D of A and
/// C_j, and D of B and C_j is 1 less the first-order index without a control variate. Dimensionless; all
/// bounds are NaN where V is 0.
namespace zerocount::sensitivity {

/// Number of pairs, all values 0 or 1.
struct AnswerPairs {
  std::int64_t both_yes{0};
  std::int64_t different{0};
  std::int64_t both_no{0};
};

/// @param x, y of the same length, 0 or 1.
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

/// D of answers that are yes or no. With u the proportion of different pairs among those with a yes in them
/// and v among those with a no,
///
///   D = u/(2 − u) + v/(2 − v),
///
/// and u and v are proportions of independent pairs with bounds of Clopper and Pearson. Those of the sum come
/// from those of its parts by the method of variance estimates recovery (Zou & Donner, Stat. Med. 27, 2008),
/// with the correlation √((1 − u)(1 − v)) of the logits of u and v. 1 − D is the intraclass kappa of two
/// raters (Donner & Eliasziw, Stat. Med. 11, 1992).
///
/// Without a different pair low is 0 and high of the order of 3.7/(2N V) (95 %); with one, low is above 0.
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

/// Share of the variance that may come from rows rarer than those seen: without one, an event has at most the
/// probability −ln(δ)/N with the confidence 1 − δ, δ = (1 − confidence)/2 (Poisson; at 95 % 3.7/N), and
/// changes the output as much as independent trials that differ do on average. They have the mean square
/// difference 2V, so the proportion is −ln(δ)/m, m the number of rows in which A and B differ; 1 at most.
inline double unseen_index(std::span<const double> a, std::span<const double> b, double confidence) {
  double different = 0.0;
  for (std::size_t r = 0; r < a.size(); ++r) different += a[r] != b[r] ? 1.0 : 0.0;
  const double events = -std::log(0.5 * (1.0 - confidence));
  return events < different ? events / different : 1.0;
}

/// Bounds by resampling with what it cannot draw, rows rarer than those seen: another independent part, added
/// as in the method of variance estimates recovery.
inline BoundedNumber with_unseen(const BoundedNumber& resampled, double unseen) {
  const double value = resampled.value;
  const double below = std::fmax(0.0, value - resampled.low);
  const double above = std::fmax(0.0, resampled.high - value);
  return {value, value - std::hypot(below, unseen), value + std::hypot(above, unseen)};
}

}  // namespace zerocount::sensitivity
