#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Progress of a run or an array job, from the files that it has written.
namespace zerocount::run_status {

/// The parts of an array job.
struct PartCounts {
  std::int64_t all{0};
  std::int64_t complete{0};
  std::int64_t running{0};
  std::int64_t interrupted{0};  ///< have finished trials, and no process runs them

  std::int64_t waiting() const { return all - complete - running - interrupted; }
};

struct RunStatus {
  bool complete{false};      ///< the results file exists and was made from the parts
  std::string name;          ///< of the study; empty if no file could be read
  std::int64_t trials{0};    ///< of all points together; the most that there may be, if `stop` decides
  std::int64_t finished{0};  ///< trials in complete files
  std::int64_t shards{0};    ///< finished, not counting complete parts
  bool running{false};       ///< the output, or one of its parts
  bool stopped{false};       ///< incomplete, no process runs it, and no part waits to begin
  std::optional<PartCounts> parts{};
  std::vector<std::string> problems{};  ///< files that cannot be read, or were set aside as damaged
  double rate{std::numeric_limits<double>::quiet_NaN()};  ///< trials/s; NaN: unknown

  double remaining() const { return static_cast<double>(trials - finished) / rate; }  ///< s
};

/// The state of the run that makes `output`.
///
/// An output or part is running if a process has it locked. Where there is the lock file of another machine,
/// whose lock may not be seen here: if its newest shard is younger than a minute. The rate is the sum of
/// those of the processes that run: the trials whose shards one has written since it began, over the time up
/// to the newest of them.
///
/// Reads only the headers of the files with trials, without checking their checksums.
/// @throws Failure: bad_input if there is neither a file nor a run; bad_data if the file is not a
/// complete results file; machine_failed if a directory cannot be read.
RunStatus status_of(const std::filesystem::path& output);

}  // namespace zerocount::run_status
