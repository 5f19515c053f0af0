#pragma once

#include <filesystem>
#include <stop_token>
#include <string_view>

#include "core/failure/failure.hpp"
#include "experiments/study/study.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/earlier_shards.hpp"

namespace zerocount::study_run {

struct SequentialRunSettings {
  int threads{0};  ///< 0: all cores
  bool quiet{false};
  ForeignShards foreign{ForeignShards::refuse};
  status::Listener listener{};
  timeline::Timeline* timeline{nullptr};  ///< gets spans of the stages; null: none
};

/// Start of the last override in the file of such a study; the final number of trials follows.
inline constexpr std::string_view decided_key = "stop.max_trials=";

/// Runs a study with `stop`: blocks of trials at every point, until the rule is met. The decision depends
/// only on the trials, so an interrupted and continued run gives the same result.
///
/// The file `output` is that
/// of the study with an additional override of `stop.max_trials` by the final number of trials. An existing
/// file is replaced.
/// @throws Failure (interrupted) if `stop` was requested.
void run_sequential(const study::Study& study, const std::filesystem::path& output,
                    const SequentialRunSettings& settings, const std::stop_token& stop);

}  // namespace zerocount::study_run
