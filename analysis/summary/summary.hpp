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

/// How far a run has come.
struct UnfinishedStudy {
  std::int64_t finished{0};  ///< trials that the summary is of
  std::int64_t trials{0};    ///< of the study; the most that there may be, if `stop` decides
  std::int64_t points{0};    ///< of the study, with trials or without
};

/// The summary of a study. Vectors by point have the length of `points`.
struct StudySummary {
  std::string name;                             ///< of the study
  std::vector<std::string> labels;              ///< [point]
  std::vector<study::SweepAxis> axes;           ///< each with a value per point
  std::map<std::string, std::string> observed;  ///< point label → what was observed on the real machine
  std::string design{"monte_carlo"};            ///< its word in the manifest
  double confidence{statistics::summary_confidence};               ///< of all bounds
  std::vector<measures::PointSummary> points;                      ///< [point]
  std::vector<theory::PointPrediction> predictions{};              ///< [point], or empty where not computed
  study::StudyFeatures features{};                                 ///< what the table has columns for
  goal::Question question{};                                       ///< what the study is judged by
  std::vector<std::string> conditions{};                           ///< names; empty without conditions
  std::vector<std::vector<worlds::WorldInput>> world_inputs{};     ///< [point] unknown and derived
  std::uint64_t seed{0};                                           ///< of the study
  std::optional<UnfinishedStudy> unfinished{};                     ///< where the run has not ended
  std::map<std::string, study::ObservedCounts> observed_counts{};  ///< point label → counts that are tested
  std::optional<study::StoppingRule> stop{};  ///< of a complete study that decided how many trials it took
  std::optional<iso230::RepeatabilitySummary> repeatability{};  ///< of a study with a sequence
  /// Points with all statistics, in their order; empty: every point. Of the others only those are known that
  /// points are chosen by (summary_answer::summarise_selected), and they are in no table.
  std::vector<std::int64_t> complete{};

  /// The measures that the points have statistics of.
  const layout::MeasureTable& table() const {
    if (points.empty()) return layout::measure_table(features);
    return *points[complete.empty() ? 0 : static_cast<std::size_t>(complete.front())].table;
  }
};

/// The numbers of the points with all statistics.
std::vector<std::int64_t> complete_points(const StudySummary& summary);

/// @throws Failure (bad_data) where labels, axes, statistics and predictions are not of the same points
void require_consistent(const StudySummary& summary);

/// The observations on the real machine at `point`; empty where there are none.
std::string observed_at(const StudySummary& summary, std::int64_t point);

/// The properties of a study as a whole.
StudySummary summary_without_points(const study::Study& study, double confidence);

/// Adds to the statistics what the study says of their points.
/// @param numbers [point] its number in the study
void describe_points(StudySummary& summary, const study::Study& study, std::span<const std::int64_t> numbers);

/// The summary of a complete results file. What was observed comes from its manifest, what the criteria say
/// from the columns of its /point: the trials are not drawn again. Every bound is found anew.
/// @throws Failure (bad_input) for a confidence outside (0, 1), (bad_data) where the file is damaged.
StudySummary summarise(const reading::AllTrialsFile& file, double confidence = statistics::summary_confidence,
                       bool bootstrap = false);

/// Summarises the sums of a file that keeps statistics; errors as above.
StudySummary summarise(const reading::ResultsFile& file, double confidence = statistics::summary_confidence,
                       bool bootstrap = false);
/// Summarises the file `path`, whether it keeps trials or statistics.
StudySummary summarise_file(const std::filesystem::path& path,
                            double confidence = statistics::summary_confidence, bool bootstrap = false);

/// Computes the bounds of means by resampling of these points of a summary that has none.
/// @param path of the complete results file that it is of
void add_mean_bounds(StudySummary& summary, const std::filesystem::path& path,
                     std::span<const std::int64_t> points);

/// The summary of a run that has not ended: of the trials in its shards and parts (shards::finished_pieces).
/// In a study with machines, only the trials of a point before the first that is missing count, so that
/// machines have equal numbers of them. Points without trials at the end are left out, and so are statements
/// about all trials.
/// @param output the results file that the run makes
/// @throws Failure (bad_data) where there is no finished trial, a shard is damaged or of another study;
/// (bad_input) where a shard vanishes, as shards do when the run ends.
StudySummary summarise_unfinished(const std::filesystem::path& output, double confidence, bool bootstrap);

}  // namespace zerocount::summary
