#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <stop_token>
#include <string_view>
#include <vector>

#include "analysis/summary_answer/parts.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "core/failure/failure.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/results_file.hpp"
#include "results/reading/trial_tables.hpp"
#include "results/shards/concatenate.hpp"
#include "results/shards/shard.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/status/status.hpp"

namespace zerocount::study_run {

/// Settings of assemble().
struct AssembleSettings {
  std::span<const theory::PointPrediction> predictions{};  ///< Predictions (theory::study_predictions).
  shards::Renumbering renumber{};                          ///< Renumbering of trials (shards::MergeOptions).
  std::stop_token stop{};
  timeline::Timeline* timeline{nullptr};  ///< Receives spans of the stages; null: none.
};

/// Joins shards into the results file `output`. A file with the whole study gets the statistics of all design
/// points.
/// @throws Failure; see MergedFile.
void assemble(std::span<const shards::ShardInfo> shards, const study::Study& study,
              const std::filesystem::path& output, layout::RowRange rows,
              const AssembleSettings& settings = {});

/// Runs about `trials` new trials of a design point of a results file on all cores, without writing a file.
/// Everything is drawn anew, including the draws made once per study, from a seed that follows from the
/// study's seed. The design is monte_carlo, whatever the design of the file. Every machine is tried under
/// every setting of the study.
///
/// In a study with machines, every trial has a machine of its own, so that Clopper–Pearson bounds hold.
/// Exception: if the study has a goal, each new machine has as many trials as a machine of the file. The
/// result does not depend on the number of cores.
/// @param plugin the user's controller, if the study has one
/// @throws Failure (bad_input) for a study without targets, or whose plugin is not loaded.
summary_answer::Confirmation confirm_point(const reading::ResultsFile& file, std::int64_t point,
                                           std::int64_t trials,
                                           std::shared_ptr<const plugin::ControllerPlugin> plugin);

/// File name extension of damaged shards, which are kept.
inline constexpr const char* damaged_extension = ".damaged";

/// Shards of earlier runs.
struct EarlierShards {
  std::vector<shards::ShardInfo> usable;   ///< Usable shards in ascending order of rows, without overlaps.
  std::vector<std::filesystem::path> all;  ///< Paths of all valid shards of the study.
};

/// Selects shards within `wanted` that do not overlap. Shards of runs with other parts may overlap or extend
/// beyond `wanted`. Trials of unused shards are run again.
EarlierShards choose_shards(const std::vector<shards::ShardInfo>& sound, layout::RowRange wanted);

/// Treatment of shards of another study.
enum class ForeignShards { refuse, remove };

/// Finds the shards of earlier runs, and checks their checksums. Damaged shards are renamed, and their trials
/// are run again.
/// @throws Failure (bad_input) if the folder has shards of another study and `refuse` is given.
EarlierShards earlier_shards(const std::filesystem::path& directory, const study::Study& study,
                             layout::RowRange wanted, ForeignShards foreign = ForeignShards::refuse);

/// Removes the shards, and also their folder if it is empty afterwards.
void remove_shards(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& shards);

/// Positions of the retained trials' records in a file, by global row.
using RecordPlaces = std::map<std::int64_t, layout::RowRange>;

RecordPlaces places_of_records(const reading::TrialTables& trials);

/// Reads the kept trials among `rows` with all their stored data.
/// @param first_row row that rows.first gets in the study for which the trials are read
/// @throws Failure as TrialTables
std::vector<shards::TrialResult> read_trials(const reading::TrialTables& trials, layout::RowRange rows,
                                             std::int64_t first_row, const RecordPlaces& records);

/// Treatment of an existing output file.
enum class ExistingUse {
  none,      ///< There is no file, or it is replaced.
  complete,  ///< The file has all wanted trials.
  extend     ///< The file is complete, and the study differs from it only by having more trials.
};

/// Use that a run makes of an existing output file.
/// @param wanted rows of the run
/// @throws Failure (bad_input) for any other file, with the differences
ExistingUse use_of_existing(const std::filesystem::path& output, const study::Study& study,
                            layout::RowRange wanted);

/// Request to run a study into a results file.
struct FileRun {
  study::Study study;
  std::filesystem::path output;
  layout::RowRange wanted;  ///< Rows of the study that are to be in the file.
  int threads{0};           ///< Number of threads; 0: all processors of the computer.
  bool quiet{false};
  ForeignShards foreign{ForeignShards::refuse};
  bool check_room{true};  ///< Whether to refuse a run for which the disk has no room.
  status::Listener listener{};
  timeline::Timeline* timeline{nullptr};  ///< Receives spans of the stages; null: none.
};

/// Runs a study without `stop`: runs the missing trials into shards, and writes the results file.
/// @throws Failure: interrupted if `stop` was requested; the finished trials are kept in shards
void run_to_file(const FileRun& request, ExistingUse existing, const std::stop_token& stop);

/// Beginning of the last override in the results file of a study with `stop`. The final number of trials
/// follows.
inline constexpr std::string_view decided_key = "stop.max_trials=";

/// Runs a study with `stop`: blocks of trials at every point, until the stopping rule is met. The decision
/// depends only on the trials, so an interrupted and resumed run gives the same result.
///
/// The output is the results file of the study with one more override, of `stop.max_trials` by the final
/// number of trials. An existing file is replaced.
/// @param request request with all rows of the study; the room on the disk is not checked
/// @throws Failure (interrupted) if `stop` was requested.
void run_sequential(const FileRun& request, const std::stop_token& stop);

}  // namespace zerocount::study_run
