#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/jerks/creep_comparison.hpp"
#include "analysis/jerks/laplace_trend.hpp"
#include "analysis/measures/point_in_setting.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::jerks {

/// A jerk in whole samples.
struct SampledJerk {
  std::int64_t onset{0};      ///< first sample with an error, counted from arrival
  std::int64_t length{0};     ///< samples with an error
  std::int64_t magnitude{0};  ///< Largest |error| of the jerk, counts.
  bool agrees{false};         ///< True if the jerk has the direction of the move's holding torque.
};

/// A move after its arrival. Samples are counted from the first sample of the arrival dwell.
struct ObservedMove {
  std::int64_t trial{0};  ///< Global row of the trial in the results file.
  /// The independent cluster: the trial, or with machines the trial's machine.
  std::int64_t cluster{0};
  bool arrived{false};
  bool lost{false};         ///< the state became non-finite at an unknown time; the fields below are unset
  double sample_time{0.0};  ///< Sampling interval, s.
  std::int64_t dwell{0};    ///< first sample at which a jerk could begin
  std::int64_t end{0};      ///< number of observed samples
  std::vector<SampledJerk> jerks;
};

/// Calls `take(first, end)` for each run of samples at which a jerk could begin: from the dwell on, samples
/// whose predecessor has no error.
void for_each_run_at_risk(const ObservedMove& move,
                          const std::function<void(std::int64_t, std::int64_t)>& take);

/// Calls `take` for each move of a point, in order of trial and move.
/// @throws Failure (bad_data) if the jerks of a trial do not match the numbers that its moves counted, or are
/// outside the time of the move.
void for_each_move(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                   const std::function<void(const ObservedMove&)>& take);

// Statistics of the jerks of a design point: rates, intervals, trend, direction and magnitude. README.md of
// this folder describes the method.

/// Rate of jerks in a range of the time since arrival.
struct JerkRate {
  double from{0.0};  ///< Begin of the range, s since arrival.
  /// End of the range, s since arrival. This time itself belongs to the next range.
  double to{0.0};
  std::int64_t moves{0};             ///< Number of moves in which a jerk could have begun in the range.
  double exposure{0.0};              ///< Time in which a jerk could have begun, summed over all moves, s.
  std::int64_t jerks{0};             ///< Number of jerks that began in the range.
  double rate{statistics::unknown};  ///< jerks / exposure, 1/s
  statistics::ConfidenceInterval poisson{};  ///< Garwood bounds of the rate, 1/s, for independent jerks
  /// Variance of the jerks of a trial about rate·exposure, divided by that of a Poisson number; 1 if unknown.
  double dispersion{1.0};
  /// Garwood bounds of the rate, 1/s; jerks and exposure are divided by the dispersion if that is above 1
  /// (trials differ). These are the bounds to report.
  statistics::ConfidenceInterval bounds{};
};

/// The probabilities of JerkIntervals::quantiles.
inline constexpr std::array<double, 5> jerk_interval_probabilities{0.05, 0.25, 0.5, 0.75, 0.95};

/// Time between the onsets of successive jerks of a move, s.
struct JerkIntervals {
  std::int64_t n{0};
  double mean{statistics::unknown};
  /// Quantiles at jerk_interval_probabilities, with order-statistic bounds for the effective number of
  /// intervals.
  std::array<statistics::Quantile, jerk_interval_probabilities.size()> quantiles{};
};

/// The largest |error| of the jerks, counts.
struct JerkMagnitudes {
  statistics::ClusteredProportion one_count;  ///< proportion of jerks of one count
  /// [m] Number of jerks of magnitude m + 1; the last element also counts all larger ones.
  std::vector<std::int64_t> counts;
  double mean{statistics::unknown};
  std::int64_t max{0};
  double median_duration{statistics::unknown};   ///< Median duration of the jerks, s.
  double longest_duration{statistics::unknown};  ///< Longest duration of a jerk, s.
};

/// The jerks of all trials of a design point.
struct JerkStatistics {
  double confidence{statistics::summary_confidence};  ///< Confidence of all bounds.
  std::int64_t trials{0};
  std::int64_t moves{0};       ///< Number of moves of all trials.
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

/// Counts jerks and exposure (the time in which jerks could begin) in ranges of the time since arrival. The
/// ranges are bounded by 10^(j/5) s for integers j: five per decade.
class JerkRates {
 public:
  /// @param clusters_return whether the moves of one cluster may be interleaved with those of others: true
  /// for machines, false for trials
  explicit JerkRates(bool clusters_return = false) : clusters_return_(clusters_return) {}
  /// @param move a move that arrived and was not lost. Moves must be added in order of their trials.
  void add(const ObservedMove& move);
  /// Rates in the ranges, in order of time. The first range begins with the earliest possible jerk of any
  /// move. The last range ends with the longest observation.
  std::vector<JerkRate> rates(double confidence) const;

 private:
  struct Cluster {
    double jerks{0.0}, exposure{0.0};  ///< exposure in s
  };
  /// One range: the clusters that may still receive moves, and sums over the completed clusters.
  struct Range {
    std::map<std::int64_t, Cluster> open;
    std::int64_t move{-1};  ///< number of the last move added to this range
    std::int64_t moves{0}, clusters{0}, jerks{0};
    double exposure{0.0}, jerks_squared{0.0}, jerks_by_exposure{0.0}, exposure_squared{0.0};

    void close_clusters();
  };
  /// The range that contains a sample.
  std::int64_t range_of(std::int64_t sample, double sample_time);
  Range& range_at(std::int64_t j, const ObservedMove& move);
  void add_exposure(const ObservedMove& move, std::int64_t first, std::int64_t end);

  bool clusters_return_;
  std::map<std::int64_t, Range> ranges_;
  double sample_time_{0.0};         ///< Sample time of the last move, s.
  std::int64_t first_range_{0};     ///< Number of the range that contains sample 1 at this sample time.
  std::vector<std::int64_t> ends_;  ///< Ends of the ranges from `first_range_` on, samples.
  std::int64_t moves_{0};
  /// Earliest possible jerk of the moves so far, s.
  double earliest_{std::numeric_limits<double>::infinity()};
  double latest_{0.0};  ///< Longest observation of the moves so far, s.
};

// Output of the command `jerks`.

/// The data of one point that the command `jerks` reports.
struct PointJerks : measures::PointInSetting {
  JerkStatistics statistics{};
  CreepComparison creep;  ///< Comparison with the closed form of creep, from trials simulated again.
  CreepAgreement creep_agreement;
};

/// The reported data of a study.
struct JerkReport {
  std::string name;  ///< Name of the study.
  double confidence{statistics::summary_confidence};
  std::vector<PointJerks> points;
};

/// The jerks of `points` (all points if empty) of a complete results file, in each setting.
/// `creep_trials` trials of each point are simulated again and compared with the closed form of creep.
/// @throws Failure as jerk_statistics.
JerkReport jerk_report(const reading::AllTrialsFile& file, std::vector<std::int64_t> points,
                       double confidence, std::int64_t creep_trials);

/// Whether any move arrived. Without an arrival there are no measurements.
bool any_arrival(const JerkReport& report);

/// The answer of `jerks`: for each point its numbers in words, the table of rates and the intervals.
document::AnswerDescription<JerkReport> jerk_answer();

}  // namespace zerocount::jerks
