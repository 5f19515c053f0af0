#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/basis/statistics/unknown.hpp"

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

/// Laplace's statistic of the intervals between the jerks of one move, with its mean and variance over all
/// orders of the intervals.
struct TrendTerm {
  std::int64_t intervals{0};  ///< Number m of intervals between the jerks of the move.
  /// Laplace's statistic ΣT_j minus its mean over all orders of the intervals, in the unit of the intervals.
  /// Negative if the intervals grow, that is, if jerks slow down.
  double excess{0.0};
  /// Variance of the excess over all orders of the intervals, in the squared unit of the intervals.
  double variance{0.0};
};

/// Computes Laplace's statistic of one move.
/// @param intervals intervals between its jerks in the order of time, whole samples
TrendTerm trend_term(std::span<const std::int64_t> intervals);

/// Standardised statistic excess/√variance: mean 0 and standard deviation 1 without a trend, negative if the
/// intervals grow; NaN with fewer than two intervals or if all are equal.
double trend_score(const TrendTerm& term);

/// One-sided p-values of a trend within one move: the proportions of orders of its intervals whose statistic
/// is at most, and at least, the observed one.
struct TrendProbability {
  double slowing{1.0};
  double quickening{1.0};
};

/// Computes the one-sided p-values of a trend within one move. For up to 7 intervals all orders are counted,
/// otherwise 999 random orders and the observed one.
/// @param intervals intervals between its jerks in the order of time, samples
/// @param move number of the move, on which the random orders depend
TrendProbability trend_probability(std::span<const std::int64_t> intervals, std::uint32_t move);

/// Result of the test whether jerks slow down, for single moves and for all moves together.
struct TrendSummary {
  std::int64_t moves{0};  ///< Number of moves that have at least two different intervals.
  /// Number of these moves with at least min_trend_intervals intervals, which are tested one by one.
  std::int64_t tested{0};
  /// Number of tested moves whose jerks slow down (intervals grow), each with the stated confidence
  /// (one-sided).
  std::int64_t slowing{0};
  /// Number of tested moves whose jerks speed up (intervals shrink), each with the stated confidence
  /// (one-sided).
  std::int64_t quickening{0};
  /// Standardised trend of all moves: Σ excess/√(Σ variance). Mean 0 and standard deviation 1 without a
  /// trend, negative if jerks slow down.
  double summed{statistics::unknown};
  /// Stouffer's combination Σ score/√moves, in which all moves have the same weight; negative if jerks slow
  /// down.
  double stouffer{statistics::unknown};
  /// One-sided p-value of `summed` for the hypothesis of no trend; small if jerks slow down.
  double p_slowing{statistics::unknown};
  /// Number of permutations behind p_slowing; 0: p_slowing comes from the normal limit of `summed`.
  std::int64_t permutations{0};
};

/// Smallest number of intervals with which a single move is tested: with four intervals there are 24 orders,
/// so that one can be significant at 5 %.
inline constexpr std::int64_t min_trend_intervals = 4;

/// Number of random orders for the intervals of all moves together. The smallest possible p_slowing is
/// therefore 1/10000.
inline constexpr std::int64_t trend_permutations = 9999;

/// Largest total number of intervals for which p_slowing comes from permutations. With more intervals the sum
/// is approximately normal (combinatorial central limit theorem of Hoeffding).
inline constexpr std::int64_t max_permuted_intervals = 20000;

/// Collects the intervals of the moves of a design point, and tests them for a trend.
class TrendSum {
 public:
  /// Creates an empty collection.
  /// @param confidence confidence of the one-sided tests of single moves
  explicit TrendSum(double confidence);
  /// Adds one move.
  /// @param intervals intervals between its jerks in the order of time, whole samples
  void add(std::span<const std::int64_t> intervals);
  /// Tests the moves added so far. The result is deterministic and does not depend on the number of threads.
  TrendSummary summary();

 private:
  struct Move {
    std::uint32_t number;
    std::vector<std::int64_t> intervals;
  };
  /// Tests each move in `untested_` for a trend, in parallel.
  void test_moves();

  double level_{0.0};  ///< p-value below which a single move has a trend (1 − confidence).
  TrendSummary counted_;
  double excess_{0.0};
  double variance_{0.0};
  double scores_{0.0};
  std::int64_t intervals_{0};
  /// [move] Intervals between the jerks of each move, kept as long as there are few enough for permutations.
  std::vector<std::vector<std::int64_t>> kept_;
  std::vector<Move> untested_;
};

}  // namespace zerocount::jerks
