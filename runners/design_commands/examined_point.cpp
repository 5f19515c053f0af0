#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/trials/goal/question.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/trials/variant.hpp"

namespace zerocount::design_commands {

std::int64_t named_point(const command_line::Arguments& arguments, const study::Study& study) {
  const std::optional<std::int64_t> point = commands::study_point(arguments, study);
  if (!point && study::point_count(study) > 1)
    throw Failure(ExitCode::bad_input, fmt::format("{}: it has {} design points; expected one with --point",
                                                   arguments.operands()[0], study::point_count(study)));
  return point.value_or(0);
}

ExaminedPoint point_to_examine(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  study::Study study = commands::load_study(path, arguments);
  goal::require_targets(study, path);
  const std::int64_t point = named_point(arguments, study);
  study::Study one = trials::restricted_to(study, arguments.value("condition"),
                                           command_line::number_option(arguments, "age", 0.0));
  return {std::move(one), point, std::move(study)};
}

std::int64_t ExaminedPoint::trial_in_whole(std::int64_t trial) const {
  const study::TrialIndices indices = study::trial_indices(study);
  if (whole.settings.empty()) return trial;
  const std::string label = study::label_of(study.settings, indices.setting_of(trial));
  return study::trial_indices(whole).trial_of(indices.draw_of(trial), study::setting_labelled(whole, label));
}

document::Description<tuning::ClaimNames> named_claim_columns(std::string goal_heading,
                                                              std::string condition_heading,
                                                              std::string goal_key) {
  return document::Description<tuning::ClaimNames>()
      .value(optional({std::move(goal_key), std::move(goal_heading), "its goal, of several"}),
             &tuning::ClaimNames::goal)
      .value(optional({"condition", std::move(condition_heading), "its condition, with conditions"}),
             &tuning::ClaimNames::setting);
}

command_line::OptionSpec condition_option() {
  return {"condition", "NAME", "under this condition alone"};
}

command_line::OptionSpec age_option() {
  return {"age", "A", "at this age of the study alone"};
}

command_line::OptionSpec set_option() {
  return {"set", "KEY=VALUE", "override a manifest key, e.g. controller.delay=1; may be repeated", true};
}

command_line::OptionSpec named_point_option() {
  return {"point", "P", "the design point, by label or number, or 'best' of a results file"};
}

}  // namespace zerocount::design_commands
