#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/reported_study.hpp"
#include "core/trial/trial.hpp"
#include "results/shards/shard.hpp"

/// The figures of a report. A figure is omitted if the study lacks its data.
namespace zerocount::report {

/// A trial that was simulated again, with the samples for a figure.
struct ReplayedTrial {
  std::int64_t point{0};
  trial::TrialParameters parameters;
  shards::TrialResult result;                ///< Result, for comparison with the record in the file.
  std::vector<trial::SampleRecord> samples;  ///< Thinned samples, see TraceThinner.
};

/// Reduces the samples of a trial while it runs, so that a line through the kept samples looks the same.
/// The samples are divided into at most `buckets` groups of equal length. Of each group the first, the last,
/// and those with the minimum and maximum error and torque are kept, so that a jerk of one sample remains
/// visible. Samples with the same count, torque and target as both neighbours are dropped. (Jugel et al.
/// 2014, M4.)
class TraceThinner {
 public:
  TraceThinner(std::int64_t samples, std::int64_t buckets);
  void add(const trial::SampleRecord& sample);
  /// The kept samples, in order.
  std::vector<trial::SampleRecord> finish();

 private:
  void close_bucket();

  std::int64_t bucket_length_;
  std::int64_t bucket_{0};
  std::vector<trial::SampleRecord> at_hand_;
  std::vector<trial::SampleRecord> kept_;
};

/// Simulates a trial of the study again with the reference engine. The caller sets ReplayedTrial::row.
/// @param buckets number of groups of samples; a figure shows the extremes of each group
ReplayedTrial replay_trial(const study::Study& study, std::int64_t point, std::int64_t index,
                           std::int64_t buckets);

/// Success rate per point with bounds and the required rate. It is drawn over a swept number if there is one,
/// otherwise as a row per point and setting. Several goals have a panel each. Nothing for an open-loop
/// study.
std::optional<Figure> success_figure(const ReportedStudy& reported);

/// Success over two swept numbers, with the curves of the criteria (6) and (7): one map for each combination
/// of the other axes.
std::vector<Figure> stability_maps(const ReportedStudy& reported);

/// Distribution functions with bounds. With goals: the times from which the error at the chosen point stays
/// within each goal, in each setting, with the goals. Without a goal: the arrival times at several
/// points, and the settling times in each band.
std::vector<Figure> distribution_figures(const ReportedStudy& reported);

/// Figures for the chosen point of a study with ages: the proportions of moves and machines that meet the
/// goal at each age, and the lives of the machines as a survival curve.
std::vector<Figure> age_figures(const ReportedStudy& reported);

/// Figures for the chosen point of a study with worlds: the settling times in each world, and the rates over
/// each parameter that differs between the worlds (at most six).
std::vector<Figure> world_figures(const ReportedStudy& reported);

/// Jerks of single moves, and the rate of jerks, at the point with the most jerks.
std::vector<Figure> jerk_figures(const ReportedStudy& reported);

/// Profiles along the rotor with the failed trials, and the success rate by position.
std::vector<Figure> rotor_figures(const ReportedStudy& reported);

/// Bode plot of the open loops of trial 0 of the chosen point (theory::trial_loops).
std::optional<Figure> bode_figure(const ReportedStudy& reported);

/// A shown trial of the study.
struct SampleTrial {
  std::string name;  ///< Name: "median" or "worst".
  std::int64_t point{0};
  std::int64_t index{0};
  std::int64_t buckets{400};  ///< Largest number of groups of samples, see TraceThinner.
  std::string setting{};      ///< Setting; empty without settings.
};

/// The median and the worst trial of the chosen point in each setting, in order of goal::Badness. Empty
/// for an open-loop study.
std::vector<SampleTrial> sample_trials(const ReportedStudy& reported);

/// Simulates a trial of the study again.
using Replay = std::function<ReplayedTrial(const SampleTrial&)>;

/// Errors of the sample trials over time with the goals, and the torque of the worst.
std::vector<Figure> response_figures(const ReportedStudy& reported, const Replay& replay);

/// The figures of the paper that the study can reproduce: Fig. 4 and 6 for torque levels, Fig. 7 for moves to
/// different targets, Fig. 8 for one long move with jerks.
std::vector<Figure> paper_figures(const ReportedStudy& reported, const Replay& replay);

}  // namespace zerocount::report
