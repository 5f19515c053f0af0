#pragma once

#include <filesystem>
#include <stop_token>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/earlier_shards.hpp"
#include "runners/study_run/existing_output.hpp"

namespace zerocount::study_run {

/// Request to run a study without `stop` into a results file.
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

/// Runs the trials that are missing, by way of shards, and writes the results file.
/// @throws Failure: interrupted if `stop` was requested; the finished trials are kept in shards.
void run_to_file(const FileRun& request, ExistingUse existing, const std::stop_token& stop);

}  // namespace zerocount::study_run
