#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/machine/monitor/move_log.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/command_line/command_line.hpp"

/// Common functions of the commands on machines in use: reading logs of moves, and choosing the simulated
/// moves with which they are compared.
namespace zerocount::result_commands {

/// Reads a log of a machine's moves from a file that is complete.
/// @param group name of the column with the groups of moves; empty: none
monitor::MoveLog read_log(const std::filesystem::path& path, const std::string& group = {});

/// Refuses a path that cannot be the log of a machine, such as a directory.
void require_log(const std::filesystem::path& path);
/// Refuses a log that is larger than read_log() reads.
/// @param size size of the log, bytes
void require_log_size(const std::filesystem::path& path, std::size_t size);

/// A log of a machine's moves that another process is still writing. The file may be rewritten or replaced,
/// as copies of a growing log are, as long as it begins with the part that was read. To check this, the first
/// and the last bytes of this part are compared each time.
class GrowingLog {
 public:
  /// @param path path of the log
  /// @param group name of the column with the groups of moves; empty: none
  explicit GrowingLog(std::filesystem::path path, const std::string& group = {})
      : path_(std::move(path)), log_(path_.string(), group) {}

  /// Reads the lines that were added to the log since the last call.
  /// @returns whether they contain moves
  /// @throws Failure (bad_data) if the file no longer begins with the part that was read
  bool read();
  const monitor::MoveLog& log() const { return log_; }

 private:
  void require_same_beginning(std::ifstream& file, std::size_t size) const;
  [[noreturn]] void refuse_replaced(std::string_view first) const;
  void remember(std::string_view text);

  std::filesystem::path path_;
  monitor::MoveLog log_;
  std::size_t read_{0};  ///< Number of bytes of the log that were read.
  std::string first_{};  ///< First bytes of the part of the log that was read.
  std::string last_{};   ///< Last bytes of the part of the log that was read.
};

/// Trials of a results file under the condition --condition at the age --age. A study with several conditions
/// or ages needs these options.
reading::AllTrialsFile with_setting(const command_line::Arguments& arguments, reading::AllTrialsFile file);

/// Index of the design point that the option --point names. A study with several points needs this option.
/// @param labels labels of all design points
std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels);

}  // namespace zerocount::result_commands
