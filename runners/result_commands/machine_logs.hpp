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

/// What the commands on machines in use have in common: logs of moves, and the simulated moves beside them.
namespace zerocount::result_commands {

/// Reads all of a log. @param group column of the groups of moves; empty: none
monitor::MoveLog read_log(const std::filesystem::path& path, const std::string& group = {});

/// Refuses what read_log() does not open, such as a directory.
void require_log(const std::filesystem::path& path);
/// Refuses a log of more bytes than read_log() reads.
void require_log_size(const std::filesystem::path& path, std::size_t size);

/// A log that another process writes. It may be written anew or moved, as a copy of a growing log is, as long
/// as it begins with what was read: its first and the last bytes that were read are compared each time.
class GrowingLog {
 public:
  /// @param group as read_log() has it
  explicit GrowingLog(std::filesystem::path path, const std::string& group = {})
      : path_(std::move(path)), log_(path_.string(), group) {}

  /// Reads the lines that are new. @returns whether there are moves among them
  /// @throws Failure (bad_data) if the file does not begin any more with what was read
  bool read();
  const monitor::MoveLog& log() const { return log_; }

 private:
  void require_same_beginning(std::ifstream& file, std::size_t size) const;
  [[noreturn]] void refuse_replaced(std::string_view first) const;
  void remember(std::string_view text);

  std::filesystem::path path_;
  monitor::MoveLog log_;
  std::size_t read_{0};  ///< bytes
  std::string first_{};  ///< bytes that were read
  std::string last_{};   ///< likewise, up to read_
};

/// The trials under the condition of --condition at the age of --age, which a study with several needs.
reading::AllTrialsFile with_condition(const command_line::Arguments& arguments, reading::AllTrialsFile file);

/// The point of --point, which a study with several points needs.
std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels);

}  // namespace zerocount::result_commands
