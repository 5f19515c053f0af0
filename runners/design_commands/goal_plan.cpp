#include "runners/design_commands/goal_plan.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/goal/goal_text.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/summary/judged_point.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::design_commands {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view other_plans = ", or --success, --halfwidth or --margin";

Json needs_json(const goal::Needs& needs) {
  return {{"rigs", needs.rigs}, {"trials", needs.trials}};
}

void print_plan_of_study(const study::Study& study, bool json) {
  const bool on_rigs = study.rigs > 0;
  const std::size_t points = study.point_labels.size();
  const std::vector<goal::Needs> studies =
      goal::smallest_studies(*study.goal, on_rigs, study.moves, points, study.worlds);
  if (json) {
    Json plans = Json::array();
    for (const goal::Needs& one : studies) plans.push_back(needs_json(one));
    standard_output::write(text::json_text(
        {{"goal", goal::goal_sentence(*study.goal)}, {"worlds", study.worlds}, {"plans", plans}}));
    return;
  }
  std::string text = fmt::format("goal: {}\n", goal::goal_sentence(*study.goal));
  if (studies.empty()) {
    text += "no study of up to 10⁹ trials can meet it\n";
  } else if (!on_rigs) {
    text += fmt::format("met from {} trials on, if no move misses it\n", studies.front().trials);
  } else {
    std::vector<text::TextColumn> columns{
        {"rigs", true, {}}, {"trials on each", true, {}}, {"trials", true, {}}};
    for (const goal::Needs& one : studies) {
      columns[0].cells.push_back(std::to_string(one.rigs));
      columns[1].cells.push_back(std::to_string(one.trials / one.rigs));
      columns[2].cells.push_back(std::to_string(one.trials));
    }
    text += "the fewest rigs with which it can be met, if no move misses it:\n\n" +
            text::aligned_table(columns) + "\n";
  }
  if (study.worlds > 0)
    text += fmt::format("in all {} worlds together, each with as many as the others\n", study.worlds);
  if (points > 1) text += fmt::format("at the best of the {} points\n", points);
  text +=
      "Moves that miss it take more: 'zerocount plan PILOT' says how many, from the results of a small "
      "study\n";
  standard_output::write_fitted(text);
}

void print_plan_of_pilot(const std::string& path, bool json) {
  const summary::StudySummary summary = summary::summarise_file(path);
  goal::require_claim(summary.question.claim(), path, other_plans);
  const summary::JudgedPoint judged = summary::judge_point(summary, summary::choose_point(summary));
  if (json) {
    const bool known = judged.needs && judged.needs->trials > 0;
    standard_output::write(text::json_text({{"goal", goal::goal_sentence(*summary.question.claim())},
                                            {"status", goal::text_of(judged.verdict.status)},
                                            {"needed", known ? needs_json(*judged.needs) : Json()},
                                            {"probability", goal::probability_of_needs}}));
    return;
  }
  standard_output::write_fitted(summary::judgement_text(summary, judged) +
                                (judged.needs ? "" : "  decided by these trials\n"));
}

}  // namespace

ExitCode print_goal_plan(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  const bool json = arguments.choice("format") == "json";
  if (commands::is_results_file(path)) {
    if (arguments.has("set")) arguments.refuse("option '--set' needs a MANIFEST");
    print_plan_of_pilot(path, json);
    return ExitCode::success;
  }
  const study::Study study = commands::load_study(path, arguments);
  goal::require_claim(study.goal, path, other_plans);
  print_plan_of_study(study, json);
  return ExitCode::success;
}

}  // namespace zerocount::design_commands
