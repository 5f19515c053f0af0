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
  double excess{0.0};    ///< ΣT_j less its mean, in units of the intervals: negative if the intervals grow
  double variance{0.0};  ///< of the excess over all orders of the intervals
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

/// By all orders for up to 7 intervals, otherwise by 999 random ones and the observed one.
/// @param move its number, which the random orders depend on.
TrendProbability trend_probability(std::span<const std::int64_t> intervals, std::uint32_t move);

/// Test whether jerks slow down, per move and for all moves together.
struct TrendSummary {
  std::int64_t moves{0};       ///< moves with at least two intervals that differ
  std::int64_t tested{0};      ///< of them, those with min_trend_intervals or more
  std::int64_t slowing{0};     ///< of those tested, slowing down with the stated confidence (one-sided)
  std::int64_t quickening{0};  ///< of those tested, speeding up with the stated confidence (one-sided)
  /// Σ excess/√(Σ variance) of all moves: mean 0 and standard deviation 1 without a trend, negative if jerks
  /// slow down.
  double summed{statistics::unknown};
  double stouffer{statistics::unknown};   ///< Σ score/√moves: all moves have the same weight
  double p_slowing{statistics::unknown};  ///< of `summed`: small if jerks slow down
  std::int64_t permutations{0};           ///< that p_slowing comes from; 0: from the normal limit of `summed`
};

/// Fewest intervals of which an order can be significant at 5 %: there are 24 orders of four.
inline constexpr std::int64_t min_trend_intervals = 4;

/// Random orders of the intervals of all moves together; p_slowing is 1/10000 at least.
inline constexpr std::int64_t trend_permutations = 9999;

/// Intervals of all moves together up to which p_slowing comes from permutations. With more, their sum is
/// normal (the combinatorial central limit theorem of Hoeffding).
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
  /// Tests the moves that wait for it, in parallel.
  void test_moves();

  double level_{0.0};  ///< p below which a single move has a trend
  TrendSummary counted_;
  double excess_{0.0};
  double variance_{0.0};
  double scores_{0.0};
  std::int64_t intervals_{0};
  std::vector<std::vector<std::int64_t>> kept_;  ///< [move], while there are few enough to permute
  std::vector<Move> untested_;
};

}  // namespace zerocount::jerks
