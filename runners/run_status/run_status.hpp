#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Determines the progress of a run or an array job from the files that it has written.
namespace zerocount::run_status {

/// Numbers of the parts of an array job (a study whose parts run as separate processes), by their state.
struct PartCounts {
  std::int64_t all{0};
  std::int64_t complete{0};
  std::int64_t running{0};
  std::int64_t interrupted{0};  ///< Number of parts with finished trials that no process runs any more.

  std::int64_t waiting() const { return all - complete - running - interrupted; }
};

/// State of a run of a study, or of an array job that runs its parts.
struct RunStatus {
  /// Whether the results file exists with all trials. For an array job: whether it was made from the parts.
  bool complete{false};
  std::string name;  ///< Name of the study; empty if no file could be read.
  /// Number of trials of all design points together; the maximum number if a stopping rule decides.
  std::int64_t trials{0};
  std::int64_t finished{0};  ///< Number of trials that are in files written completely.
  std::int64_t shards{0};    ///< Number of shards (files with finished trials), without complete parts.
  bool running{false};       ///< Whether a process runs the output or one of its parts at the moment.
  bool stopped{false};  ///< Whether the run is incomplete, no process runs it, and no part waits to begin.
  std::optional<PartCounts> parts{};
  /// Messages about files that cannot be read, or were set aside as damaged.
  std::vector<std::string> problems{};
  /// Speed of all running processes together, trials/s; NaN: unknown.
  double rate{std::numeric_limits<double>::quiet_NaN()};

  /// Remaining time at the present speed, s; NaN if the speed is unknown.
  double remaining() const { return static_cast<double>(trials - finished) / rate; }
};

/// State of the run that makes `output`.
///
/// An output or part is running if a process has locked it. The lock of another computer may not be visible
/// here, so if there is a lock file of another computer, the part is running if its newest shard is younger
/// than a minute. The rate is the sum over the running processes. Each contributes the trials of the shards
/// written since it began, divided by the time up to the newest of these shards.
///
/// Only the headers of the files with trials are read, without checking their checksums.
/// @throws Failure: bad_input if there is neither a file nor a run; bad_data if the file is not a
/// complete results file; machine_failed if a directory cannot be read.
RunStatus status_of(const std::filesystem::path& output);

}  // namespace zerocount::run_status
