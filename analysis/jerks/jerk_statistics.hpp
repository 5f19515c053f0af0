#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/jerks/creep_comparison.hpp"
#include "analysis/jerks/laplace_trend.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/unknown.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"

/// Statistics of the jerks of a design point: rates, intervals, trend, direction and magnitude. README.md of
/// this folder describes the method.
namespace zerocount::jerks {

/// Rate of jerks in a range of the time since arrival.
struct JerkRate {
  double from{0.0};                  ///< s since arrival
  double to{0.0};                    ///< s since arrival; `to` itself belongs to the next range
  std::int64_t moves{0};             ///< moves in which a jerk could have begun in the range
  double exposure{0.0};              ///< s, sum over all moves of the time in which a jerk could have begun
  std::int64_t jerks{0};             ///< that began in the range
  double rate{statistics::unknown};  ///< jerks / exposure, 1/s
  statistics::ConfidenceInterval poisson{};  ///< Garwood bounds of the rate, 1/s, for independent jerks
  /// Variance of the jerks of a trial about rate·exposure, divided by that of a Poisson number; 1 if unknown.
  double dispersion{1.0};
  /// Garwood bounds of the rate, 1/s; jerks and exposure are divided by the dispersion if that is above 1
  /// (trials differ). These are the bounds to report.
  statistics::ConfidenceInterval bounds{};
};

/// Time between the onsets of successive jerks of a move, s.
struct JerkIntervals {
  std::int64_t n{0};
  double mean{statistics::unknown};
  /// At jerk_interval_probabilities, with order-statistic bounds for the effective number of intervals.
  std::vector<statistics::Quantile> quantiles;
  std::vector<double> independent;  ///< [quantile]: effective number of intervals
};

/// The probabilities of JerkIntervals::quantiles.
inline constexpr std::array<double, 5> jerk_interval_probabilities{0.05, 0.25, 0.5, 0.75, 0.95};

/// The largest |error| of the jerks, counts.
struct JerkMagnitudes {
  statistics::ClusteredProportion one_count;  ///< proportion of jerks of one count
  std::vector<std::int64_t> counts;           ///< [m]: jerks of magnitude m + 1; last: or more
  double mean{statistics::unknown};
  std::int64_t max{0};
  double median_duration{statistics::unknown};   ///< s
  double longest_duration{statistics::unknown};  ///< s
};

/// The jerks of all trials of a design point.
struct JerkStatistics {
  double confidence{statistics::summary_confidence};  ///< of all bounds
  std::int64_t trials{0};
  std::int64_t moves{0};       ///< of all trials
  std::int64_t arrived{0};     ///< moves that arrived; only these can jerk
  std::int64_t lost{0};        ///< moves that became non-finite after arrival; excluded below
  std::int64_t with_jerks{0};  ///< trials with at least one jerk
  std::int64_t jerks{0};
  std::vector<JerkRate> rates;  ///< consecutive ranges, equally spaced in the logarithm
  JerkIntervals intervals;
  TrendSummary slowing;                       ///< trend of the intervals between the jerks of a move
  statistics::ClusteredProportion agreement;  ///< jerks in the direction of their holding torque
  JerkMagnitudes magnitudes;
};

/// The jerks of one design point of a complete results file.
/// @throws Failure: bad_input if there is no such point or the confidence is outside (0, 1); bad_data for an
/// open-loop study, which has no jerks, and for inconsistent data.
JerkStatistics jerk_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                               std::int64_t point, double confidence = statistics::summary_confidence);

/// The data of one point that the verb `jerks` reports.
struct PointJerks {
  std::int64_t point{0};
  std::string label;                       ///< with the condition, if there is one
  std::optional<std::string> condition{};  ///< that its trials are under
  JerkStatistics statistics{};
  CreepComparison creep;  ///< from trials simulated again
  CreepAgreement creep_agreement;
};

}  // namespace zerocount::jerks
