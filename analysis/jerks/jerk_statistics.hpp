#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "analysis/jerks/creep_comparison.hpp"
#include "analysis/jerks/laplace_trend.hpp"
#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/quantile.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/study_file.hpp"

/// The jerks of a design point: how often they come, at what intervals, whether they slow down, where they go
/// and how far. The method is described in README.md of this folder.
namespace zerocount {

/// How often jerks begin in a range of the time since arrival.
struct JerkRate {
  double from{0.0};       ///< s since arrival
  double to{0.0};         ///< s since arrival; `to` itself belongs to the next range
  std::int64_t moves{0};  ///< moves in which a jerk could have begun in the range
  double exposure{0.0};   ///< s, of all moves: the time in which a jerk could have begun
  std::int64_t jerks{0};  ///< that began in the range
  double rate{std::numeric_limits<double>::quiet_NaN()};  ///< jerks / exposure, 1/s
  ConfidenceInterval poisson{};  ///< of the rate, 1/s: Garwood's, if jerks come independently of each other
  /// Variance of the jerks of a trial about rate·exposure over that of a Poisson number; 1 where unknown.
  double dispersion{1.0};
  /// Of the rate, 1/s: Garwood's with jerks and exposure divided by the dispersion where it is beyond 1, as
  /// it is where trials differ. What to report.
  ConfidenceInterval bounds{};
};

/// Time between the onsets of successive jerks of a move, s.
struct JerkIntervals {
  std::int64_t n{0};
  double mean{std::numeric_limits<double>::quiet_NaN()};
  /// Of jerk_interval_probabilities, with order-statistic bounds for the number of independent intervals.
  std::vector<Quantile> quantiles;
  std::vector<double> independent;  ///< [quantile]: that number, n where trials do not differ
};

/// The probabilities of JerkIntervals::quantiles.
inline constexpr std::array<double, 5> jerk_interval_probabilities{0.05, 0.25, 0.5, 0.75, 0.95};

/// The largest |error| of the jerks, counts.
struct JerkMagnitudes {
  ClusteredProportion one_count;     ///< jerks of one count among all
  std::vector<std::int64_t> counts;  ///< [m]: jerks of magnitude m + 1; the last one: of that or more
  double mean{std::numeric_limits<double>::quiet_NaN()};
  std::int64_t max{0};
  double median_duration{std::numeric_limits<double>::quiet_NaN()};   ///< s
  double longest_duration{std::numeric_limits<double>::quiet_NaN()};  ///< s
};

/// The jerks of all trials of a design point.
struct JerkStatistics {
  double confidence{summary_confidence};  ///< of all bounds
  std::int64_t trials{0};
  std::int64_t moves{0};       ///< of all trials
  std::int64_t arrived{0};     ///< moves that arrived: those that can jerk
  std::int64_t lost{0};        ///< moves that arrived and whose motion was lost then: left out of the rest
  std::int64_t with_jerks{0};  ///< trials with a jerk at least
  std::int64_t jerks{0};
  std::vector<JerkRate> rates;  ///< ranges spaced evenly in the logarithm, without a gap
  JerkIntervals intervals;
  LaplaceSummary slowing;         ///< of the jerks after the first of their move
  ClusteredProportion agreement;  ///< jerks in the direction of their move's holding torque among all
  JerkMagnitudes magnitudes;
};

/// The jerks of one design point of a complete results file.
/// @throws Failure: bad_input where there is no such point or the confidence is outside (0, 1), bad_data for
/// an open-loop study, which has no jerks, and where the file contradicts itself.
JerkStatistics jerk_statistics(const StudyFile& file, const Study& study, std::int64_t point,
                               double confidence = summary_confidence);

/// What is told of one point by the verb `jerks`.
struct PointJerks {
  std::int64_t point{0};
  std::string label;
  JerkStatistics statistics;
  CreepComparison creep;  ///< of trials that were run again
  CreepAgreement creep_agreement;
};

}  // namespace zerocount
