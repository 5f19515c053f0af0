#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/jerks/creep_comparison.hpp"
#include "analysis/trials/jerks/laplace_trend.hpp"
#include "analysis/trials/measures/point_in_setting.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::jerks {

/// A jerk after arrival (an interval in which the error is not 0), in whole samples.
struct SampledJerk {
  std::int64_t onset{0};  ///< First sample with an error, counted from the first sample of the arrival dwell.
  std::int64_t length{0};     ///< Duration of the jerk: number of successive samples whose error is not 0.
  std::int64_t magnitude{0};  ///< Magnitude: largest |error| during the jerk, counts.
  /// True if the jerk has the direction (sign of count − target at its onset) of the move's holding torque.
  bool agrees{false};
};

/// The part of a move after its arrival, with its jerks. Samples are counted from the first sample of the
/// arrival dwell.
struct ObservedMove {
  std::int64_t trial{0};  ///< Row of the trial in the results file, counted over all design points.
  /// Index of the independent cluster of moves: the trial, or in a study with machines the trial's machine.
  std::int64_t cluster{0};
  bool arrived{false};
  /// True: the state became non-finite at an unknown time; the members below are then unset.
  bool lost{false};
  double sample_time{0.0};  ///< Sampling interval, s.
  /// First sample at which a jerk could begin: the number of samples of the arrival dwell.
  std::int64_t dwell{0};
  std::int64_t end{0};  ///< Number of observed samples, from the first sample of the arrival dwell.
  std::vector<SampledJerk> jerks;
};

/// Calls `take(first, end)` for each run of samples [first, end) of the move at which a jerk could begin:
/// samples after the arrival dwell whose predecessor has no error.
void for_each_run_at_risk(const ObservedMove& move,
                          const std::function<void(std::int64_t, std::int64_t)>& take);

/// Calls `take` for each move of a design point, in order of trial and move.
/// @throws Failure (bad_data) if the jerks of a trial do not match the numbers that its moves counted, or are
/// outside the time of the move.
void for_each_move(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                   const std::function<void(const ObservedMove&)>& take);

// Statistics of the jerks of a design point: rates, intervals, trend, direction and magnitude. README.md of
// this folder describes the method.

/// Rate of jerks per time in a range of the time since arrival.
struct JerkRate {
  double from{0.0};  ///< Beginning of the range of the time since arrival, s.
  /// End of the range of the time since arrival, s. This time itself belongs to the next range.
  double to{0.0};
  std::int64_t moves{0};             ///< Number of moves in which a jerk could have begun in the range.
  double exposure{0.0};              ///< Time in which a jerk could have begun, summed over all moves, s.
  std::int64_t jerks{0};             ///< Number of jerks that began in the range.
  double rate{statistics::unknown};  ///< Rate of jerks: jerks / exposure, 1/s.
  statistics::ConfidenceInterval poisson{};  ///< Garwood bounds of the rate, 1/s, if jerks were independent.
  /// Dispersion: variance of the number of jerks of a trial about rate·exposure, divided by the variance of a
  /// Poisson number; 1 if unknown.
  double dispersion{1.0};
  /// Bounds of the rate to be reported, 1/s: Garwood bounds for which jerks and exposure are divided by the
  /// dispersion if it is above 1 (trials differ).
  statistics::ConfidenceInterval bounds{};
};

/// The probabilities of the quantiles in JerkIntervals::quantiles, in their order.
inline constexpr std::array<double, 5> jerk_interval_probabilities{0.05, 0.25, 0.5, 0.75, 0.95};

/// Statistics of the time between the onsets of successive jerks of a move, s.
struct JerkIntervals {
  std::int64_t n{0};
  double mean{statistics::unknown};
  /// Quantiles of the intervals at jerk_interval_probabilities, s, with order-statistic bounds for the
  /// effective number of independent intervals.
  std::array<statistics::Quantile, jerk_interval_probabilities.size()> quantiles{};
};

/// Statistics of the magnitude of jerks (their largest |error|, counts) and of their duration.
struct JerkMagnitudes {
  statistics::ClusteredProportion one_count;  ///< Proportion of jerks with a magnitude of one count.
  /// [m] Number of jerks with a magnitude of m + 1 counts; the last element also counts all larger ones.
  std::vector<std::int64_t> counts;
  double mean{statistics::unknown};
  std::int64_t max{0};
  double median_duration{statistics::unknown};   ///< Median duration of the jerks, s.
  double longest_duration{statistics::unknown};  ///< Longest duration of a jerk, s.
};

/// Statistics of the jerks of all trials of a design point.
struct JerkStatistics {
  double confidence{statistics::summary_confidence};  ///< Confidence of all bounds.
  std::int64_t trials{0};
  std::int64_t moves{0};    ///< Number of moves of all trials.
  std::int64_t arrived{0};  ///< Number of moves that arrived at their target; only these can have jerks.
  /// Number of moves that became non-finite after arrival; they are excluded from the statistics below.
  std::int64_t lost{0};
  std::int64_t with_jerks{0};  ///< Number of trials with at least one jerk.
  std::int64_t jerks{0};
  /// Rates of jerks in consecutive ranges of the time since arrival; the ranges are equally long in the
  /// logarithm of the time.
  std::vector<JerkRate> rates;
  JerkIntervals intervals;
  /// Test whether jerks slow down: trend of the intervals between the jerks of a move.
  TrendSummary slowing;
  /// Proportion of jerks whose direction (sign of count − target at the onset) is that of their move's
  /// holding torque.
  statistics::ClusteredProportion agreement;
  JerkMagnitudes magnitudes;
};

/// The jerks of one design point of a complete results file.
/// @throws Failure: bad_input if there is no such point or the confidence is outside (0, 1); bad_data for an
/// open-loop study, which has no jerks, and for inconsistent data.
JerkStatistics jerk_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                               std::int64_t point, double confidence = statistics::summary_confidence);

/// Counts jerks and exposure (the time in which jerks could begin) in ranges of the time since arrival. The
/// ranges end at 10^(j/5) s for integers j: five per decade.
class JerkRates {
 public:
  /// Creates an empty count.
  /// @param clusters_return whether the moves of one cluster may be interleaved with those of others: true if
  /// clusters are machines, false if they are trials
  explicit JerkRates(bool clusters_return = false) : clusters_return_(clusters_return) {}
  /// Adds the jerks and the exposure of a move.
  /// @param move a move that arrived and was not lost. Moves must be added in order of their trials.
  void add(const ObservedMove& move);
  /// Rates in the ranges with bounds, in order of time. The first range begins with the earliest possible
  /// jerk of any move. The last range ends with the longest observation.
  /// @param confidence confidence of the bounds
  std::vector<JerkRate> rates(double confidence) const;

 private:
  struct Cluster {
    double jerks{0.0}, exposure{0.0};  ///< Number of jerks, and exposure in s, of the cluster in one range.
  };
  /// One range of the time since arrival: the clusters that may still receive moves, and sums over the
  /// completed clusters.
  struct Range {
    std::map<std::int64_t, Cluster> open;
    std::int64_t move{-1};  ///< Number of the move that was added to this range last; −1 if there is none.
    std::int64_t moves{0}, clusters{0}, jerks{0};
    double exposure{0.0}, jerks_squared{0.0}, jerks_by_exposure{0.0}, exposure_squared{0.0};

    void close_clusters();
  };
  /// Index of the range that contains this sample.
  /// @param sample samples since arrival
  /// @param sample_time sampling interval, s
  std::int64_t range_of(std::int64_t sample, double sample_time);
  Range& range_at(std::int64_t j, const ObservedMove& move);
  void add_exposure(const ObservedMove& move, std::int64_t first, std::int64_t end);

  bool clusters_return_;
  std::map<std::int64_t, Range> ranges_;
  double sample_time_{0.0};  ///< Sampling interval of the move that was added last, s.
  /// Number j of the range that contains sample 1 at the sampling interval `sample_time_`.
  std::int64_t first_range_{0};
  /// Ends of the ranges from number `first_range_` on, in samples since arrival.
  std::vector<std::int64_t> ends_;
  std::int64_t moves_{0};
  /// Earliest time since arrival at which a move added so far could have a jerk, s.
  double earliest_{std::numeric_limits<double>::infinity()};
  double latest_{0.0};  ///< Longest observed time since arrival of the moves added so far, s.
};

// Output of the command `jerks`.

/// The data of one design point, in one setting, that the command `jerks` reports.
struct PointJerks : measures::PointInSetting {
  JerkStatistics statistics{};
  /// Comparison of the jerks with the closed form of creep, from trials that were simulated again.
  CreepComparison creep;
  CreepAgreement creep_agreement;
};

/// The data that the command `jerks` reports on a study.
struct JerkReport {
  std::string name;  ///< Name of the study.
  double confidence{statistics::summary_confidence};
  std::vector<PointJerks> points;
};

/// The data of the command `jerks`: the jerks of the design points `points` (all points if empty) of a
/// complete results file, in each setting. The first `creep_trials` trials of each point are simulated again
/// and compared with the closed form of creep.
/// @throws Failure in the cases of jerk_statistics()
JerkReport jerk_report(const reading::AllTrialsFile& file, std::vector<std::int64_t> points,
                       double confidence, std::int64_t creep_trials);

/// Whether any move of the report arrived at its target. Without an arrival there are no measurements of
/// jerks.
bool any_arrival(const JerkReport& report);

/// Description of the answer of the command `jerks`: for each point its numbers in words, the table of rates
/// and the intervals between jerks.
document::AnswerDescription<JerkReport> jerk_answer();

}  // namespace zerocount::jerks
