#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/monitor/move_log.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/command_line/command_line.hpp"

/// Common functions of the commands on machines in use: logs of moves, and the simulated moves that belong to
/// them.
namespace zerocount::result_commands {

/// Reads a complete log.
/// @param group column with the groups of moves; empty: none
monitor::MoveLog read_log(const std::filesystem::path& path, const std::string& group = {});

/// Refuses a path that read_log() does not open, such as a directory.
void require_log(const std::filesystem::path& path);
/// Refuses a log of more bytes than read_log() reads.
void require_log_size(const std::filesystem::path& path, std::size_t size);

/// A log that another process writes. The file may be rewritten or replaced, as copies of a growing log are,
/// as long as it begins with the part that was read. To check this, the first and the last bytes of this part
/// are compared each time.
class GrowingLog {
 public:
  /// @param group as for read_log()
  explicit GrowingLog(std::filesystem::path path, const std::string& group = {})
      : path_(std::move(path)), log_(path_.string(), group) {}

  /// Reads new lines.
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
  std::size_t read_{0};  ///< Number of bytes that were read.
  std::string first_{};  ///< First bytes of the part that was read.
  std::string last_{};   ///< Last bytes of the part that was read, up to read_.
};

/// Trials of the condition --condition at the age --age. A study with several settings or ages
/// needs these options.
reading::AllTrialsFile with_setting(const command_line::Arguments& arguments, reading::AllTrialsFile file);

/// Design point of the option --point. A study with several points needs this option.
std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels);

}  // namespace zerocount::result_commands
