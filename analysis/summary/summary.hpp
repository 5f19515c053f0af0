#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/goal/question.hpp"
#include "analysis/iso230/columns.hpp"
#include "analysis/measures/point_statistics.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "analysis/worlds/world_rule.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::summary {

/// Progress of a run that has not ended.
struct UnfinishedStudy {
  std::int64_t finished{0};  ///< Number of trials in the summary.
  std::int64_t trials{0};    ///< Number of trials of the whole study; with `stop` the maximum number.
  std::int64_t points{0};    ///< Number of points of the study, including those without trials.
};

/// The summary of a study. Vectors by point have the length of `points`.
struct StudySummary {
  std::string name;                                    ///< Name of the study.
  std::vector<std::string> labels;                     ///< [point]
  std::vector<study::SweepAxis> axes;                  ///< each with a value per point
  std::map<std::string, std::string> observed;         ///< {point label: observations on the real machine}
  std::string design{"monte_carlo"};                   ///< Design of the study, as the manifest writes it.
  double confidence{statistics::summary_confidence};   ///< Confidence of all bounds.
  std::vector<measures::PointSummary> points;          ///< [point]
  std::vector<theory::PointPrediction> predictions{};  ///< [point]; empty if not computed
  study::StudyFeatures features{};                     ///< Features for which tables have columns.
  goal::Question question{};                           ///< Criteria by which the study is judged.
  /// [point] unknown and derived quantities of worlds; empty for a point that is not complete.
  std::vector<std::vector<worlds::WorldInput>> world_inputs{};
  std::uint64_t seed{0};                                           ///< Seed of the study.
  std::optional<UnfinishedStudy> unfinished{};                     ///< Set if the run has not ended.
  std::map<std::string, study::ObservedCounts> observed_counts{};  ///< {point label: counts to be tested}
  std::optional<study::StoppingRule> stop{};  ///< Set for a complete study that used the rule.
  std::optional<iso230::RepeatabilitySummary> repeatability{};  ///< Set for a study with a sequence.
  /// Points with all statistics, in their order; empty: every point. For the other points only the statistics
  /// by which points are chosen are known (summarise_chosen(), summary_answer::summarise_selected()); tables
  /// do not show them.
  std::vector<std::int64_t> complete{};

  /// The measures for which the points have statistics.
  const layout::MeasureTable& table() const {
    if (points.empty()) return layout::measure_table(features);
    return *points[complete.empty() ? 0 : static_cast<std::size_t>(complete.front())].table;
  }
};

/// The numbers of the points with all statistics (StudySummary::complete, or every point).
std::vector<std::int64_t> points_with_all_statistics(const StudySummary& summary);

/// @throws Failure (bad_data) unless labels, axes, statistics and predictions have the same number of points
void require_consistent(const StudySummary& summary);

/// The observations on the real machine at `point`; empty if there are none.
std::string observed_at(const StudySummary& summary, std::int64_t point);

/// The properties of a study as a whole.
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
/// The summary of a file without its points and predictions.
/// @throws Failure (bad_data) if trials are missing or have another number of moves than the manifest gives
StudySummary summary_without_points(const reading::AllTrialsFile& file, double confidence);
StudySummary summary_without_points(const reading::ResultsFile& file, double confidence);

/// Computes all statistics of these points of a summary that has points. They become StudySummary::complete.
/// @param points numbers of points, rising @param bootstrap whether means get bounds by resampling
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
