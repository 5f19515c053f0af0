#include "runners/result_commands/machine_logs.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/yaml/text_file.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::result_commands {
namespace {

constexpr std::size_t max_log_size = std::size_t{1} << 31;  // bytes
constexpr std::string_view expected_log = "a log of moves";

constexpr std::size_t bytes_compared = 4096;  // bytes at each end of what was read

std::string bytes_at(std::ifstream& file, std::size_t first, std::size_t count) {
  std::string text(count, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(first));
  file.read(text.data(), static_cast<std::streamsize>(count));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

std::string first_line(std::string_view text) {
  constexpr std::size_t longest = 120;
  return text::printable(text.substr(0, std::min(text.find_first_of("\r\n"), longest)));
}

}  // namespace

monitor::MoveLog read_log(const std::filesystem::path& path, const std::string& group) {
  const std::string text = yaml::read_text(path, max_log_size, expected_log);
  require_log_size(path, text.size());
  monitor::MoveLog log(yaml::name_of_text(path), group);
  log.read_last(std::string_view(text).substr(log.read(text)));
  log.require_header();
  return log;
}

void require_log(const std::filesystem::path& path) {
  static_cast<void>(yaml::read_text(path, 0, expected_log));
}

void require_log_size(const std::filesystem::path& path, std::size_t size) {
  if (size > max_log_size)
    throw Failure(ExitCode::bad_input, fmt::format("{}: the file is too large; expected at most {} bytes",
                                                   yaml::name_of_text(path), max_log_size));
}

bool GrowingLog::read() {
  std::ifstream file(path_, std::ios::binary);
  if (!file) throw Failure(ExitCode::bad_input, fmt::format("{}: cannot be read", path_.string()));
  file.seekg(0, std::ios::end);
  const auto end = static_cast<std::streamoff>(file.tellg());
  if (end < 0) throw Failure(ExitCode::bad_input, fmt::format("{}: cannot be read", path_.string()));
  const auto size = static_cast<std::size_t>(end);
  require_log_size(path_, size);
  require_same_beginning(file, size);
  const std::int64_t before = log_.moves;
  const std::string text = bytes_at(file, read_, size - read_);
  // Zero bytes at the end are room for lines to come.
  if (read_ == 0)
    yaml::require_text(path_.string(), std::string_view(text).substr(0, text.find_last_not_of('\0') + 1),
                       expected_log);
  remember(std::string_view(text).substr(0, log_.read(text)));
  return log_.moves > before;
}

void GrowingLog::require_same_beginning(std::ifstream& file, std::size_t size) const {
  const std::string first = bytes_at(file, 0, first_.size());
  if (size >= read_ && first == first_ && bytes_at(file, read_ - last_.size(), last_.size()) == last_) return;
  if (first_line(first) != first_line(first_) && !first.empty()) refuse_replaced(first);
  if (size < read_)
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: became shorter while it was followed; expected a file that only grows",
                              path_.string()));
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: another log took its place after {} moves; expected a file that only grows",
                            path_.string(), log_.moves));
}

void GrowingLog::refuse_replaced(std::string_view first) const {
  throw Failure(ExitCode::bad_data,
                fmt::format("{}:1: the line became '{}' while the log was followed; expected '{}', as it was",
                            path_.string(), first_line(first), first_line(first_)));
}

void GrowingLog::remember(std::string_view text) {
  read_ += text.size();
  if (first_.size() < bytes_compared) first_ += text.substr(0, bytes_compared - first_.size());
  last_ += text;
  if (last_.size() > bytes_compared) last_.erase(0, last_.size() - bytes_compared);
}

reading::AllTrialsFile with_setting(const command_line::Arguments& arguments, reading::AllTrialsFile file) {
  const std::int64_t setting = study::setting_named(file.study(), arguments.value("condition"),
                                                    command_line::number_option(arguments, "age", 0.0));
  if (file.study().settings.empty()) return file;
  return file.in_setting(setting);
}

std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels) {
  const std::optional<std::int64_t> point = command_line::point_option(arguments, labels);
  if (!point && labels.size() > 1)
    arguments.refuse(fmt::format("option '--point': {} has {} points; expected the one of the machine",
                                 arguments.operands()[0], labels.size()));
  return point.value_or(0);
}

}  // namespace zerocount::result_commands
