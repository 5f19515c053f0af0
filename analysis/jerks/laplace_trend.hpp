#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/unknown.hpp"

namespace zerocount::jerks {

/// Laplace's statistic of one series of instants 1 … M, of which n have an event.
struct LaplaceTerm {
  std::int64_t events{0};  ///< n
  double excess{0.0};      ///< Σ of the events' instants − n(M + 1)/2: negative if the events are early
  double variance{0.0};    ///< of the excess: n(M + 1)(M − n)/12
};

/// Laplace's test for a trend in time (Cox and Lewis, The Statistical Analysis of Series of Events, 1966,
/// section 3.3), for discrete instants.
///
/// If all M instants are equally likely to have one of the n events, the
/// sum of the events' instants has the mean n(M + 1)/2 and the variance n(M + 1)(M − n)/12. For M ≫ n these
/// are Laplace's n·M/2 and n·M²/12.
/// @param instants of the events, 1 … M, all different. @param size M.
LaplaceTerm laplace_term(std::span<const std::int64_t> instants, std::int64_t size);

/// excess/√variance, standard normal without a trend; NaN without events or with zero variance.
double laplace_score(const LaplaceTerm& term);

/// Test whether jerks slow down, per move and for all moves together. The events of a move are its jerks
/// after the first.
struct LaplaceSummary {
  std::int64_t moves{0};       ///< moves with at least one event
  std::int64_t tested{0};      ///< of them, those with min_laplace_events or more
  std::int64_t slowing{0};     ///< of those tested, slowing down with the stated confidence (one-sided)
  std::int64_t quickening{0};  ///< of those tested, speeding up with the stated confidence (one-sided)
  /// Σ excess/√(Σ variance) of all moves: standard normal without a trend, negative if jerks slow down.
  double summed{statistics::unknown};
  double stouffer{statistics::unknown};   ///< Σ score/√moves: all moves have the same weight
  double p_slowing{statistics::unknown};  ///< Φ(summed): small if jerks slow down
};

/// Minimum number of events for which the score of one series is close enough to normal for a test at 5 %.
inline constexpr std::int64_t min_laplace_events = 4;

/// Collects the moves of a design point.
class LaplaceSum {
 public:
  /// @param confidence of the one-sided tests of single moves.
  explicit LaplaceSum(double confidence);
  void add(const LaplaceTerm& term);
  LaplaceSummary summary() const;

 private:
  double critical_{0.0};  ///< |score| above which a single move has a trend
  LaplaceSummary counted_;
  double excess_{0.0};
  double variance_{0.0};
  double scores_{0.0};
};

}  // namespace zerocount::jerks
