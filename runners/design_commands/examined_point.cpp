#include "runners/design_commands/examined_point.hpp"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/goal/question.hpp"
#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/study_argument.hpp"

namespace zerocount::design_commands {
study::Study study_in_file(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  if (arguments.has("set"))
    arguments.refuse("option '--set': changes a manifest, not a results file; expected a manifest");
  const reading::ResultsFile file(path);
  if (file.header().plugin)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its controller is a plugin, which the file does not contain; expected its "
                              "manifest",
                              path));
  return file.study();
}

std::int64_t named_point(const command_line::Arguments& arguments, const study::Study& study) {
  const std::optional<std::int64_t> point = command_line::point_option(arguments, study.points.labels);
  if (!point && study::point_count(study) > 1)
    throw Failure(ExitCode::bad_input, fmt::format("{}: it has {} design points; expected one with --point",
                                                   arguments.operands()[0], study::point_count(study)));
  return point.value_or(0);
}

ExaminedPoint point_to_examine(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  study::Study study =
      commands::is_results_file(path) ? study_in_file(arguments) : commands::load_study(path, arguments);
  goal::require_targets(study, path);
  const std::int64_t point = named_point(arguments, study);
  return {std::move(study), point};
}

command_line::OptionSpec set_option() {
  return {"set", "KEY=VALUE", "override a manifest key, e.g. controller.delay=1; may be repeated", true};
}

command_line::OptionSpec named_point_option() {
  return {"point", "P", "the design point, by label or number"};
}

}  // namespace zerocount::design_commands
