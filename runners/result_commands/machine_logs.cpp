#include "runners/result_commands/machine_logs.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"
#include "runners/command_line/option_values.hpp"

namespace zerocount::result_commands {
namespace {

constexpr std::size_t max_log_size = std::size_t{1} << 31;  // bytes

}  // namespace

monitor::MoveLog read_log(const std::filesystem::path& path) {
  const std::string text = yaml::read_text(path, max_log_size, "a log of moves");
  if (text.size() > max_log_size)
    throw Failure(ExitCode::bad_input, fmt::format("{}: the file is too large; expected at most {} bytes",
                                                   yaml::name_of_text(path), max_log_size));
  monitor::MoveLog log(yaml::name_of_text(path));
  log.read_last(std::string_view(text).substr(log.read(text)));
  log.require_header();
  return log;
}

reading::AllTrialsFile with_condition(const command_line::Arguments& arguments, reading::AllTrialsFile file) {
  const std::vector<std::string>& conditions = file.study().conditions;
  const std::optional<std::string> name = arguments.value("condition");
  if (conditions.empty()) {
    if (name) arguments.refuse("option '--condition': the study has no conditions");
    return file;
  }
  const auto found = std::ranges::find(conditions, name.value_or(""));
  if (found == conditions.end())
    arguments.refuse(fmt::format("option '--condition': expected one of {}, under which the machine moves",
                                 fmt::join(conditions, ", ")));
  return file.under_condition(found - conditions.begin());
}

std::int64_t point_of(const command_line::Arguments& arguments, const std::vector<std::string>& labels) {
  const std::optional<std::int64_t> point = command_line::point_option(arguments, labels);
  if (!point && labels.size() > 1)
    arguments.refuse(fmt::format("option '--point': {} has {} points; expected the one of the machine",
                                 arguments.operands()[0], labels.size()));
  return point.value_or(0);
}

}  // namespace zerocount::result_commands
