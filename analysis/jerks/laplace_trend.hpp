#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/statistics/unknown.hpp"

/// Test for a trend in the intervals between the jerks of a move: Laplace's statistic, calibrated by
/// permuting the intervals.
///
/// d₁ … d_m are the intervals between the jerks of a move. Jerk j after the first begins at T_j = d₁ + … +
/// d_j. Laplace's statistic is ΣT_j = Σ(m + 1 − i)·dᵢ: small if jerks come early, that is, if the intervals
/// grow (Cox and Lewis, The Statistical Analysis of Series of Events, 1966, section 3.3, here up to the last
/// event).
///
/// Its distribution for events at random (Poisson) is not that of jerks without a trend: they are more
/// regular, or come in bursts. Without a trend the intervals are exchangeable (a renewal process), also given
/// their number and sum, whatever their distribution and wherever the observation ends: the wait that the end
/// cuts off depends on the sum only. So every order of the intervals is equally likely. Then the statistic
/// has
///
///   mean d̄·m(m + 1)/2 and variance m(m + 1)/12·Σ(dᵢ − d̄)²
///
/// (Hoeffding, Ann. Math. Statist. 22 (1951) 558, theorem 2). The score is the one less the mean over the
/// root of the variance: asymptotically Laplace's score over the coefficient of variation of the intervals
/// (Lewis and Robinson, in Reliability and Biometry, SIAM 1974, 163).
namespace zerocount::jerks {

/// Laplace's statistic of the intervals of one move.
struct TrendTerm {
  std::int64_t intervals{0};  ///< m
  /// ΣT_j minus the mean over all orders, in units of the intervals. Negative if the intervals grow.
  double excess{0.0};
  double variance{0.0};  ///< Variance of the excess over all orders of the intervals.
};

/// @param intervals in the order of time, whole samples.
TrendTerm trend_term(std::span<const std::int64_t> intervals);

/// excess/√variance: mean 0 and standard deviation 1 without a trend; NaN with fewer than two intervals or if
/// all are equal.
double trend_score(const TrendTerm& term);

/// One-sided p-values of a move: the proportion of orders of its intervals with a statistic as small, and as
/// large, as that observed.
struct TrendProbability {
  double slowing{1.0};
  double quickening{1.0};
};

/// Computes the one-sided p-values of one move. For up to 7 intervals all orders are counted, otherwise 999
/// random orders and the observed one.
/// @param move number of the move, on which the random orders depend.
TrendProbability trend_probability(std::span<const std::int64_t> intervals, std::uint32_t move);

/// Test whether jerks slow down, per move and for all moves together.
struct TrendSummary {
  std::int64_t moves{0};   ///< moves with at least two intervals that differ
  std::int64_t tested{0};  ///< Number of these moves with min_trend_intervals or more intervals.
  /// Number of tested moves that slow down with the stated confidence (one-sided).
  std::int64_t slowing{0};
  /// Number of tested moves that speed up with the stated confidence (one-sided).
  std::int64_t quickening{0};
  /// Σ excess/√(Σ variance) of all moves: mean 0 and standard deviation 1 without a trend, negative if jerks
  /// slow down.
  double summed{statistics::unknown};
  double stouffer{statistics::unknown};   ///< Σ score/√moves: all moves have the same weight
  double p_slowing{statistics::unknown};  ///< One-sided p-value of `summed`; small if jerks slow down.
  /// Number of permutations behind p_slowing; 0: p_slowing comes from the normal limit of `summed`.
  std::int64_t permutations{0};
};

/// Smallest number of intervals for which an order can be significant at 5 %: four intervals have 24 orders.
inline constexpr std::int64_t min_trend_intervals = 4;

/// Number of random orders for the intervals of all moves together. The smallest possible p_slowing is
/// therefore 1/10000.
inline constexpr std::int64_t trend_permutations = 9999;

/// Largest total number of intervals for which p_slowing comes from permutations. With more intervals the sum
/// is approximately normal (combinatorial central limit theorem of Hoeffding).
inline constexpr std::int64_t max_permuted_intervals = 20000;

/// Collects the moves of a design point.
class TrendSum {
 public:
  /// @param confidence of the one-sided tests of single moves.
  explicit TrendSum(double confidence);
  /// @param intervals of one move, in the order of time, whole samples.
  void add(std::span<const std::int64_t> intervals);
  /// Deterministic; does not depend on the number of threads.
  TrendSummary summary();

 private:
  struct Move {
    std::uint32_t number;
    std::vector<std::int64_t> intervals;
  };
  /// Tests the moves in `untested_`, in parallel.
  void test_moves();

  double level_{0.0};  ///< p below which a single move has a trend
  TrendSummary counted_;
  double excess_{0.0};
  double variance_{0.0};
  double scores_{0.0};
  std::int64_t intervals_{0};
  /// [move] Intervals of each move, while there are few enough to permute.
  std::vector<std::vector<std::int64_t>> kept_;
  std::vector<Move> untested_;
};

}  // namespace zerocount::jerks
