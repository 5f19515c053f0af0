#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "analysis/monitor/move_log.hpp"

namespace zerocount::result_commands {

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

}  // namespace zerocount::result_commands
