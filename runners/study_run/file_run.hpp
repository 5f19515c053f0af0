#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <stop_token>
#include <string_view>
#include <vector>

#include "analysis/trials/summary_answer/parts.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
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

/// Settings of assemble(), which joins shards into a results file.
struct AssembleSettings {
  /// Predictions by theory for the design points (theory::study_predictions).
  std::span<const theory::PointPrediction> predictions{};
  /// Change of the trials' numbers when shards are joined (shards::MergeOptions).
  shards::Renumbering renumber{};
  std::stop_token stop{};
  timeline::Timeline* timeline{nullptr};  ///< Records the times of the stages; null: not recorded.
};

/// Joins shards (files with the trials of a run) into the results file `output`. A file with the whole study
/// gets the statistics of all design points.
/// @param rows rows of the study (numbers of its trials) that the file will have
/// @throws Failure; see MergedFile.
void assemble(std::span<const shards::ShardInfo> shards, const study::Study& study,
              const std::filesystem::path& output, layout::RowRange rows,
              const AssembleSettings& settings = {});

/// Runs about `trials` new trials of a design point of a results file on all cores, without writing a file,
/// to confirm its success rate. Everything is drawn anew, including the draws made once per study, from a
/// seed that follows from the study's seed. The design is monte_carlo, whatever the design of the file. Every
/// machine is tried under every setting (condition at an age) of the study.
///
/// Every trial of a study with machines has a machine of its own here, so that Clopper–Pearson bounds hold.
/// Exception: if the study has a goal, each new machine has as many trials as a machine of the file. The
/// result does not depend on the number of cores.
/// @param plugin the user's controller, if the study has one
/// @throws Failure (bad_input) for a study without targets, or whose plugin is not loaded.
summary_answer::Confirmation confirm_point(const reading::ResultsFile& file, std::int64_t point,
                                           std::int64_t trials,
                                           std::shared_ptr<const plugin::ControllerPlugin> plugin);

/// File name extension of damaged shards (files with trials of a run), which are renamed and kept.
inline constexpr const char* damaged_extension = ".damaged";

/// Shards (files with consecutive trials of a study) that earlier runs left.
struct EarlierShards {
  /// Shards without overlaps whose trials need not be run again, in ascending order of rows.
  std::vector<shards::ShardInfo> usable;
  /// Paths of all valid shards of the study, also of those that are not used.
  std::vector<std::filesystem::path> all;
};

/// Selects shards within `wanted` that do not overlap. Shards of runs that ran other parts of the study may
/// overlap or extend beyond `wanted`. Trials of shards that are not selected are run again.
/// @param sound valid shards in ascending order of rows
/// @param wanted rows (numbers of the trials) of this run
EarlierShards choose_shards(const std::vector<shards::ShardInfo>& sound, layout::RowRange wanted);

/// Treatment of shards of another study in the folder of this one: an error, or removal.
enum class ForeignShards { refuse, remove };

/// Finds the shards (files with trials) that earlier runs left in the folder, and checks their checksums.
/// Damaged shards are renamed, and their trials are run again.
/// @param wanted rows (numbers of the trials) of this run
/// @throws Failure (bad_input) if the folder has shards of another study and `refuse` is given.
EarlierShards earlier_shards(const std::filesystem::path& directory, const study::Study& study,
                             layout::RowRange wanted, ForeignShards foreign = ForeignShards::refuse);

/// Removes these shard files, and also their folder if it is empty afterwards.
void remove_shards(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& shards);

/// Positions of the sample records (traces) of the retained trials in a file, by the row of the trial in the
/// study.
using RecordPlaces = std::map<std::int64_t, layout::RowRange>;

RecordPlaces places_of_records(const reading::TrialTables& trials);

/// Reads from a results file the kept trials among `rows`, with all their stored data.
/// @param first_row row that the trial rows.first of the file has in the study for which the trials are read
/// @param records positions of the sample records of retained trials
/// @throws Failure as TrialTables
std::vector<shards::TrialResult> read_trials(const reading::TrialTables& trials, layout::RowRange rows,
                                             std::int64_t first_row, const RecordPlaces& records);

/// State in which a run finds its output file.
enum class ExistingUse {
  none,      ///< There is no output file, or the run replaces it.
  complete,  ///< The file already has all wanted trials, so nothing is run.
  /// The file is complete but has fewer trials than the study. The study is otherwise the same, so its trials
  /// are kept.
  extend
};

/// Decides what a run does with an existing output file.
/// @param wanted rows (numbers of the trials) that the run is to put into the file
/// @throws Failure (bad_input) for a file that is neither complete nor can be extended, with the differences
ExistingUse use_of_existing(const std::filesystem::path& output, const study::Study& study,
                            layout::RowRange wanted);

/// Request to run a study, or a part of it, into a results file.
struct FileRun {
  study::Study study;
  std::filesystem::path output;
  layout::RowRange wanted;  ///< Rows of the study (numbers of its trials) that are to be in the file.
  int threads{0};           ///< Number of threads; 0: all processors of the computer.
  bool quiet{false};
  ForeignShards foreign{ForeignShards::refuse};
  bool check_room{true};  ///< Whether to refuse a run whose file does not fit on the disk.
  status::Listener listener{};
  timeline::Timeline* timeline{nullptr};  ///< Records the times of the stages; null: not recorded.
};

/// Runs a study without a stopping rule: runs the missing trials into shards, and writes the results file
/// from them.
/// @param existing what use_of_existing() found at the output path
/// @throws Failure: interrupted if `stop` was requested; the finished trials are kept in shards
void run_to_file(const FileRun& request, ExistingUse existing, const std::stop_token& stop);

/// Beginning of the override that ends the header of a results file whose study has a stopping rule. The
/// number of trials that the rule decided on follows.
inline constexpr std::string_view decided_key = "stop.max_trials=";

/// Runs a study with a stopping rule: blocks of trials at every design point, until the rule is met. The
/// decision depends only on the trials, so an interrupted and resumed run gives the same result.
///
/// The output is the results file of the study with one more override, which sets `stop.max_trials` to the
/// final number of trials. An existing file is replaced.
/// @param request request with all rows of the study; whether the disk has room is not checked
/// @throws Failure (interrupted) if `stop` was requested.
void run_sequential(const FileRun& request, const std::stop_token& stop);

}  // namespace zerocount::study_run
