#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/iso230/columns.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/worlds/world_rule.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::summary {

/// Progress of a run that has not ended.
struct UnfinishedStudy {
  std::int64_t finished{0};  ///< Number of finished trials, which the summary covers.
  /// Number of trials of the whole study; if the study has a stopping rule (`stop`), the largest number.
  std::int64_t trials{0};
  std::int64_t points{0};  ///< Number of points of the study, including those without trials.
};

/// The summary of a study. Vectors by point have the length of `points`.
struct StudySummary {
  std::string name;  ///< Name of the study.
  /// [point] Label of the design point, which names its swept values or its case.
  std::vector<std::string> labels;
  std::vector<study::SweepAxis> axes;  ///< Swept parameters, each with a value for every design point.
  /// {label of the point: text on observations on the real machine}.
  std::map<std::string, std::string> observed;
  std::string design{"monte_carlo"};                  ///< Design of the study, as the manifest writes it.
  double confidence{statistics::summary_confidence};  ///< Confidence of all bounds.
  std::vector<measures::PointSummary> points;         ///< [point] Statistics of the design point.
  /// [point] Predictions by the stability criteria; empty if not computed.
  std::vector<theory::PointPrediction> predictions{};
  study::StudyFeatures features{};  ///< Properties of the study that decide which columns tables have.
  /// Criteria by which the study is judged: its goals or, without a goal, success.
  goal::Question question{};
  /// [point] Parameters that differ between worlds (draws of what all machines share), and derived
  /// quantities; empty for a point that is not complete.
  std::vector<std::vector<worlds::WorldInput>> world_inputs{};
  /// Seed of the study's random numbers.
  std::uint64_t seed{0};
  std::optional<UnfinishedStudy> unfinished{};  ///< Progress of the run; set if the run has not ended.
  /// {label of the point: counts on the real machine that are compared with the simulation}.
  std::map<std::string, study::ObservedCounts> observed_counts{};
  /// Stopping rule; set for a complete study whose number of trials it decided.
  std::optional<study::StoppingRule> stop{};
  /// Repeatability by ISO 230-2; set for a study with a test sequence of targets.
  std::optional<iso230::RepeatabilitySummary> repeatability{};
  /// Indices of the design points with all statistics, in their order; empty: every point. For the other
  /// points only the statistics by which points are chosen are known (summarise_chosen(),
  /// summary_answer::summarise_selected()); tables do not show them.
  std::vector<std::int64_t> complete{};

  /// The table of the measures for which the design points have statistics.
  const layout::MeasureTable& table() const {
    if (points.empty()) return layout::measure_table(features);
    return *points[complete.empty() ? 0 : static_cast<std::size_t>(complete.front())].table;
  }
};

/// The indices of the design points with all statistics (StudySummary::complete, or every point).
std::vector<std::int64_t> points_with_all_statistics(const StudySummary& summary);

/// Checks a summary.
/// @throws Failure (bad_data) unless labels, axes, statistics and predictions have the same number of points
void require_consistent(const StudySummary& summary);

/// Text on the observations on the real machine at the design point; empty if there are none.
std::string observed_at(const StudySummary& summary, std::int64_t point);

/// A summary that has only the properties of the study as a whole; its vectors by point are empty.
StudySummary summary_without_points(const study::Study& study, double confidence);

/// The summary of a complete results file. Observations come from the manifest of the file, predictions of
/// the criteria from the columns of /point, so the trials are not drawn again. All bounds are computed anew.
/// @throws Failure (bad_input) for a confidence outside (0, 1), (bad_data) if the file is damaged.
StudySummary summarise(const reading::AllTrialsFile& file, double confidence = statistics::summary_confidence,
                       bool bootstrap = false);

/// The summary of a file that keeps sums instead of trials.
/// @throws Failure (bad_input) for a confidence outside (0, 1), (bad_data) if the file is damaged.
StudySummary summarise(const reading::ResultsFile& file, double confidence = statistics::summary_confidence,
                       bool bootstrap = false);
/// A summary that has only the properties of the file's study as a whole, without its points and predictions.
/// @throws Failure (bad_data) if trials are missing or have another number of moves than the manifest gives
StudySummary summary_without_points(const reading::AllTrialsFile& file, double confidence);
StudySummary summary_without_points(const reading::ResultsFile& file, double confidence);

/// Computes all statistics of some design points of a summary that has points already. They become
/// StudySummary::complete.
/// @param points indices of the points, rising
/// @param bootstrap whether means get bounds by resampling
void complete_points(StudySummary& summary, const reading::AllTrialsFile& file,
                     std::vector<std::int64_t> points, bool bootstrap);
void complete_points(StudySummary& summary, const reading::ResultsFile& file,
                     std::vector<std::int64_t> points, bool bootstrap);

/// The summary of the file `path`, which may keep trials or only statistics.
StudySummary summarise_file(const std::filesystem::path& path,
                            double confidence = statistics::summary_confidence, bool bootstrap = false);

/// Adds bounds of means by resampling to these points of a summary without such bounds.
/// @param path path of the complete results file that was summarised
void add_mean_bounds(StudySummary& summary, const std::filesystem::path& path,
                     std::span<const std::int64_t> points);

/// The summary of a run that has not ended, from the trials in its shards and parts
/// (shards::finished_pieces). In a study with machines, only the trials of a point before the first missing
/// trial count, so that machines have equal numbers of trials. Points at the end without trials are left out,
/// and so are statements about all trials.
/// @param output path of the results file that the run will write
/// @throws Failure (bad_data) if no trial is finished, or a shard is damaged or from another study;
/// (bad_input) if a shard vanishes, as shards do when the run ends.
StudySummary summarise_unfinished(const std::filesystem::path& output, double confidence, bool bootstrap);

}  // namespace zerocount::summary
