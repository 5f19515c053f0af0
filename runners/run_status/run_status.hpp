#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Progress of a run or an array job, from the files that it has written.
namespace zerocount::run_status {

/// Counts of the parts of an array job, by their state.
struct PartCounts {
  std::int64_t all{0};
  std::int64_t complete{0};
  std::int64_t running{0};
  std::int64_t interrupted{0};  ///< Parts with finished trials that no process runs.

  std::int64_t waiting() const { return all - complete - running - interrupted; }
};

/// State of a run or an array job.
struct RunStatus {
  bool complete{false};      ///< Whether the results file exists and was made from the parts.
  std::string name;          ///< Name of the study; empty if no file could be read.
  std::int64_t trials{0};    ///< Trials of all points together; the maximum, if `stop` decides.
  std::int64_t finished{0};  ///< Number of trials in complete files.
  std::int64_t shards{0};    ///< Number of finished shards, without complete parts.
  bool running{false};       ///< Whether a process runs the output or one of its parts.
  bool stopped{false};       ///< Incomplete, no process runs it, and no part waits to begin.
  std::optional<PartCounts> parts{};
  std::vector<std::string> problems{};  ///< Files that cannot be read, or were set aside as damaged.
  double rate{std::numeric_limits<double>::quiet_NaN()};  ///< Speed, trials/s; NaN: unknown.

  /// Remaining time at this speed, s.
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
