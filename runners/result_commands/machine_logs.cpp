#include "runners/result_commands/machine_logs.hpp"

#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/condition_study.hpp"
#include "experiments/yaml/text_file.hpp"
#include "runners/command_line/option_values.hpp"

namespace zerocount::result_commands {
namespace {

constexpr std::size_t max_log_size = std::size_t{1} << 31;  // bytes
constexpr std::string_view expected_log = "a log of moves";

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

reading::AllTrialsFile with_condition(const command_line::Arguments& arguments, reading::AllTrialsFile file) {
  const std::int64_t condition = study::turn_named(file.study(), arguments.value("condition"),
                                                   command_line::number_option(arguments, "age", 0.0));
  if (file.study().conditions.empty()) return file;
  return file.under_condition(condition);
}

std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels) {
  const std::optional<std::int64_t> point = command_line::point_option(arguments, labels);
  if (!point && labels.size() > 1)
    arguments.refuse(fmt::format("option '--point': {} has {} points; expected the one of the machine",
                                 arguments.operands()[0], labels.size()));
  return point.value_or(0);
}

}  // namespace zerocount::result_commands
