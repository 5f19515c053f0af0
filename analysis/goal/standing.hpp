#pragma once

namespace zerocount::goal {

/// Difference of the logits of two proportions, ln(a/(1 − a)) − ln(b/(1 − b)): infinite where one of them is
/// 0 or 1, 0 where they are equal.
double logit_difference(double a, double b);

/// How well a claim stands. The smaller standing is the worse one: statuses decide, where they are equal the
/// bounds, where these are equal the observed proportions, and so on. Conditions, goals and ages are ranked
/// by it; design points by the number of goals met, then by it, and last by the slowest goal (merits_of()).
///
/// Few machines cap lower bounds, and of claims on machines the bounds are often 0. So bounds may be equal
/// where the observed proportions differ.
struct Standing {
  int status{0};         ///< rank_of(); 0 without a claim
  double bound{0.0};     ///< logit_difference() of the lower bound of what is claimed and what is asked for
  double observed{0.0};  ///< Like `bound`, by the observed proportion; infinite where nothing was observed.
  /// Bound and observed proportion of the moves, if the claim is about machines.
  double bound_of_moves{0.0}, observed_of_moves{0.0};
  /// Minus the 95 % quantile of the settling time, as a proportion of the time allowed; 0 where it is not
  /// known.
  double earliness{0.0};

  friend bool operator<(const Standing& a, const Standing& b);
};

}  // namespace zerocount::goal
