#pragma once

#include <filesystem>
#include <stop_token>
#include <string_view>

#include "core/failure/failure.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/earlier_shards.hpp"

namespace zerocount::study_run {

/// Treatment of an existing output file.
enum class ExistingUse {
  none,      ///< there is no file, or it is replaced
  complete,  ///< the file has all wanted trials
  extend     ///< the file is complete, and the study differs only in having more trials
};

/// @param wanted rows of the run
/// @throws Failure (bad_input) for any other file, with the differences.
ExistingUse use_of_existing(const std::filesystem::path& output, const study::Study& study,
                            layout::RowRange wanted);

/// Request to run a study into a results file.
struct FileRun {
  study::Study study;
  std::filesystem::path output;
  layout::RowRange wanted;  ///< rows of the study
  int threads{0};           ///< 0: all that the machine has
  bool quiet{false};
  ForeignShards foreign{ForeignShards::refuse};
  bool check_room{true};  ///< refuse a run for which the disk has no room
  status::Listener listener{};
  timeline::Timeline* timeline{nullptr};  ///< gets spans of the stages; null: none
};

/// Of a study without `stop`: runs the trials that are missing, by way of shards, and writes the results
/// file.
/// @throws Failure: interrupted if `stop` was requested; the finished trials are kept in shards.
void run_to_file(const FileRun& request, ExistingUse existing, const std::stop_token& stop);

/// Start of the last override in the file of such a study; the final number of trials follows.
inline constexpr std::string_view decided_key = "stop.max_trials=";

/// Runs a study with `stop`: blocks of trials at every point, until the rule is met. The decision depends
/// only on the trials, so an interrupted and continued run gives the same result.
///
/// The output is the file of the study with an additional override of `stop.max_trials` by the final number
/// of trials. An existing file is replaced.
/// @param request of all rows of the study; the room on the disk is not checked
/// @throws Failure (interrupted) if `stop` was requested.
void run_sequential(const FileRun& request, const std::stop_token& stop);

}  // namespace zerocount::study_run
