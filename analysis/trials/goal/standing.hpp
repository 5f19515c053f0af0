#pragma once

namespace zerocount::goal {

/// Difference of the logits of two proportions, ln(a/(1 − a)) − ln(b/(1 − b)): infinite if one of
/// them is 0 or 1, and 0 if they are equal.
double logit_difference(double a, double b);

/// Rank of a claim; the smaller standing is the worse one. The members are compared in their order: the
/// bounds decide if the statuses are equal, the observed proportions if the bounds are equal too, and so on.
/// Settings, goals and ages are ranked by their standing. Design points are ranked by the number of goals
/// met, then by the standing, and last by the slowest goal (merits_of()).
///
/// Few machines cap the lower bounds, and the bounds of claims on machines are often 0. So the bounds may be
/// equal although the observed proportions differ.
struct Standing {
  int status{0};  ///< Rank of the status: 0 missed, 1 undecided, 2 met (rank_of()); 0 if nothing is claimed.
  /// Difference of the logits of the lower bound and the proportion that the goal demands; positive if the
  /// bound exceeds it.
  double bound{0.0};
  /// Difference of the logits of the observed proportion and the demanded one; infinite if nothing was
  /// observed.
  double observed{0.0};
  /// If the claim is about machines: the differences `bound` and `observed` for the proportion of moves.
  double bound_of_moves{0.0}, observed_of_moves{0.0};
  /// Minus the ratio of the 95 % quantile of the settling time to the time allowed, so that larger is better;
  /// 0 if it is not known.
  double earliness{0.0};

  friend bool operator<(const Standing& a, const Standing& b);
};

}  // namespace zerocount::goal
