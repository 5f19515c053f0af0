#pragma once

#include <filesystem>
#include <stop_token>
#include <string_view>

#include "core/failure/failure.hpp"
#include "experiments/study/study.hpp"
#include "runners/study_run/earlier_shards.hpp"

namespace zerocount {

struct StoppingRunSettings {
  int threads{0};  ///< 0: all that the machine has
  bool quiet{false};
  ForeignShards foreign{ForeignShards::refuse};
};

/// The override with which the file of such a study ends, followed by the number of trials it came to.
inline constexpr std::string_view decided_key = "stop.max_trials=";

/// Runs a study with `stop`, whose results go to `output`: blocks of trials at every point, until the rule is
/// met. What it decides depends on the trials alone, so a run that is interrupted comes to the same.
///
/// The file is that of the study with `stop.max_trials` set to the number of trials it came to, at its end of
/// the overrides. What has its name already is replaced.
/// @throws Failure (interrupted) where `stop` was requested.
ExitCode run_until_sure(const Study& study, const std::filesystem::path& output,
                        const StoppingRunSettings& settings, const std::stop_token& stop);

}  // namespace zerocount
