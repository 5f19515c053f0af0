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

/// The figures of a report on a study. A figure is omitted if the study lacks its data.
namespace zerocount::report {

/// A trial that was simulated again, with the samples for a figure.
struct ReplayedTrial {
  std::int64_t point{0};
  trial::TrialParameters parameters;
  /// Result of the repeated trial, for comparison with the record in the results file.
  shards::TrialResult result;
  /// Samples of the trial over time, reduced for drawing (see TraceThinner).
  std::vector<trial::SampleRecord> samples;
};

/// Selects samples of a trial while it runs, so that a line through the kept samples looks like one through
/// all. The samples are divided into at most `buckets` groups of equal length. Of each group the first, the
/// last, and those with the minimum and maximum error and torque are kept, so that a jerk of one sample
/// remains visible. Samples with the same count, torque and target as both neighbours are dropped. (Jugel et
/// al. 2014, M4.)
class TraceThinner {
 public:
  TraceThinner(std::int64_t samples, std::int64_t buckets);
  void add(const trial::SampleRecord& sample);
  /// The kept samples, in order of time; call it after the last sample.
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

/// Figure of the success rate at each design point with its bounds and the required rate. It is drawn over a
/// swept number if there is one, otherwise as a row per point and setting (condition at an age). If there are
/// several goals, each has a panel. Nothing for an open-loop study.
std::optional<Figure> success_figure(const ReportedStudy& reported);

/// Maps of the success rate over two swept numbers, with the boundaries of the stability criteria (6) and (7)
/// of the paper: one map for each combination of the other swept parameters.
std::vector<Figure> stability_maps(const ReportedStudy& reported);

/// Distribution functions of settling times, with confidence bands. With goals: the times from which the
/// error at the chosen design point stays within each goal, in each setting (condition at an age), with the
/// goals as marks. Without a goal: the arrival times at several points, and the settling times in each error
/// band.
std::vector<Figure> distribution_figures(const ReportedStudy& reported);

/// Figures for the chosen point of a study with ages: the proportions of moves and machines that meet the
/// goal at each age, and the lives of the machines as a survival curve.
std::vector<Figure> age_figures(const ReportedStudy& reported);

/// Figures for the chosen point of a study with worlds: the settling times in each world, and the rates over
/// each parameter that differs between the worlds (at most six).
std::vector<Figure> world_figures(const ReportedStudy& reported);

/// Figures of jerks (excursions of the position error from 0 after arrival): single moves with them, and
/// their rate, at the design point with the most jerks.
std::vector<Figure> jerk_figures(const ReportedStudy& reported);

/// Figures of the parameters that vary along the rotor, with the positions of failed trials, and the success
/// rate by position.
std::vector<Figure> rotor_figures(const ReportedStudy& reported);

/// Bode plot of the open loops (theory::trial_loops) of trial 0 at the chosen design point; nothing without a
/// linear loop.
std::optional<Figure> bode_figure(const ReportedStudy& reported);

/// A trial of the study that figures show as an example.
struct SampleTrial {
  std::string name;  ///< Name of the trial in the figures: "median" or "worst".
  std::int64_t point{0};
  std::int64_t index{0};
  std::int64_t buckets{400};  ///< Largest number of groups of samples that are drawn, see TraceThinner.
  std::string setting{};      ///< Name of the setting (condition at an age); empty without settings.
};

/// The median and the worst trial at the chosen design point in each setting, ranked by goal::Badness. Empty
/// for an open-loop study.
std::vector<SampleTrial> sample_trials(const ReportedStudy& reported);

/// Function that simulates a trial of the study again and returns its samples.
using Replay = std::function<ReplayedTrial(const SampleTrial&)>;

/// Figures of the position errors of the sample trials over time, with the goals, and of the torque of the
/// worst trial.
std::vector<Figure> response_figures(const ReportedStudy& reported, const Replay& replay);

/// The figures of the paper behind this program that the study can reproduce: Fig. 4 and 6 for torque levels,
/// Fig. 7 for moves to different targets, Fig. 8 for one long move with jerks.
std::vector<Figure> paper_figures(const ReportedStudy& reported, const Replay& replay);

}  // namespace zerocount::report
