#pragma once

#include <cstdint>
#include <limits>
#include <span>

namespace zerocount {

/// The events of one series of trials at risk, numbered 1 … M.
struct LaplaceTerm {
  std::int64_t events{0};  ///< n
  double excess{0.0};      ///< Σ of their numbers less n(M + 1)/2: negative where they come early
  double variance{0.0};    ///< of the excess: n(M + 1)(M − n)/12
};

/// Laplace's test of a trend in time (Cox and Lewis, The Statistical Analysis of Series of Events, 1966,
/// section 3.3), for instants that are numbered.
///
/// If each of M instants is as likely as any other to have one of the n events, their numbers sum up to
/// n(M + 1)/2 with the variance n(M + 1)(M − n)/12. For M much larger than n that is Laplace's n·M/2 and
/// n·M²/12.
/// @param instants the numbers of the events, 1 … M, each at most once. @param size M.
LaplaceTerm laplace_term(std::span<const std::int64_t> instants, std::int64_t size);

/// excess/√variance, standard normal without a trend; NaN without an event or without a variance.
double laplace_score(const LaplaceTerm& term);

/// Whether jerks slow down: per move and for all moves together. The events of a move are its jerks after the
/// first.
struct LaplaceSummary {
  std::int64_t moves{0};       ///< moves with an event at least
  std::int64_t tested{0};      ///< of them, those with laplace_least_events or more
  std::int64_t slowing{0};     ///< of those tested, slower with the stated confidence (one-sided)
  std::int64_t quickening{0};  ///< of those tested, quicker with the stated confidence (one-sided)
  /// Σ excess/√(Σ variance) of all moves: standard normal if no move has a trend, negative where they slow
  /// down.
  double summed{std::numeric_limits<double>::quiet_NaN()};
  double stouffer{
      std::numeric_limits<double>::quiet_NaN()};  ///< Σ score/√moves: each move has the same weight
  double p_slowing{std::numeric_limits<double>::quiet_NaN()};  ///< Φ(summed): small where they slow down
};

/// From so many events on the score of one series is close enough to normal for a test at 5 %.
inline constexpr std::int64_t laplace_least_events = 4;

/// Collects the moves of a design point.
class LaplaceSum {
 public:
  /// @param confidence of the one-sided tests of single moves.
  explicit LaplaceSum(double confidence);
  void add(const LaplaceTerm& term);
  LaplaceSummary summary() const;

 private:
  double critical_{0.0};  ///< score beyond which a single move has a trend
  LaplaceSummary counted_;
  double excess_{0.0};
  double variance_{0.0};
  double scores_{0.0};
};

}  // namespace zerocount
