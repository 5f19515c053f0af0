#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "analysis/summary/judged_point.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/report_json.hpp"
#include "results/shards/pieces.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/commands.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::commands {
namespace {

constexpr const char* judge_help =
    "Judges the best design point of a finished study by the goal in its manifest, such as\n"
    "goal: {band: 1, within: 0.05, moves: 0.99, machines: 0.99, confidence: 0.95}: is the error\n"
    "within 1 count for good after 0.05 s, in at least 99 % of the moves of at least 99 % of the\n"
    "machines? One paragraph tells the point, the verdict, its bounds, and what would decide it.\n"
    "The bounds of the best of several points allow for its choice; --point judges a point that\n"
    "was chosen beforehand. In a study with worlds the goal must be met in each of them; the rates are\n"
    "those of the worst world, and a rule says what the bad worlds have in common.\n"
    "The exit code is 0 if the goal is met, 1 if it is missed, 3 if the trials do not decide it.\n"
    "\n"
    "Example: zerocount judge gains.h5\n"
    "         zerocount judge gains.h5 --point 3 --format json\n";

nlohmann::ordered_json judgement_json(const summary::StudySummary& summary,
                                      const summary::JudgedPoint& judged) {
  const goal::Verdict& verdict = judged.verdict;
  nlohmann::ordered_json json{{"point", judged.chosen.point},
                              {"label", summary.labels[static_cast<std::size_t>(judged.chosen.point)]},
                              {"status", goal::text_of(verdict.status)},
                              {"rate", verdict.moves.value},
                              {"rate_low", verdict.moves.low},
                              {"rate_high", verdict.moves.high}};
  const bool machines = summary.goal->machines.has_value();
  json["machines_low"] = machines ? nlohmann::ordered_json(verdict.machines.low) : nullptr;
  json["machines_high"] = machines ? nlohmann::ordered_json(verdict.machines.high) : nullptr;
  json["text"] = summary::judgement_text(summary, judged);
  json["chosen_from"] = judged.chosen.chosen_from;
  json["needed"] = nullptr;
  if (judged.needs && judged.needs->trials > 0)
    json["needed"] = {{"rigs", judged.needs->rigs}, {"trials", judged.needs->trials}};
  if (const auto worlds = summary::worlds_of_point(summary, judged.chosen.point,
                                                   static_cast<std::size_t>(judged.chosen.chosen_from)))
    json["worlds"] = summary::worlds_json(*worlds, summary::world_inputs_of(summary, judged.chosen.point));
  return json;
}

/// Refuses what the description of the file tells, before its trials are read.
void require_judgeable(const command_line::Arguments& arguments) {
  const std::filesystem::path path = arguments.operands()[0];
  std::error_code error;
  if (!std::filesystem::exists(path, error) && shards::has_begun(path)) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: unfinished: its run has not ended; 'zerocount run' goes on with it, and "
                              "'zerocount summary' is of the finished trials",
                              path.string()));
  }
  const study::Study study = described_study(path);
  command_line::point_option(arguments, study.point_labels);
  if (study.goal) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: its manifest has no goal; expected one such as goal: {{band: 1, within: "
                            "0.05, moves: 0.99}}",
                            path.string()));
}

ExitCode judge(const command_line::Arguments& arguments) {
  require_judgeable(arguments);
  const summary::StudySummary summary = summary::summarise_file(arguments.operands()[0]);
  const auto point = command_line::point_option(arguments, summary.labels);
  const summary::JudgedPoint judged = summary::judge_point(summary, summary::choose_point(summary, point));
  if (arguments.choice("format") == "json") {
    standard_output::write(text::json_text(judgement_json(summary, judged)));
  } else {
    standard_output::write_fitted(summary::judgement_text(summary, judged));
  }
  return exit_code_of(judged.verdict.status);
}

}  // namespace

Command judge_command() {
  return {{"judge",
           "FILE",
           {command_line::format_option({"text", "json"}),
            {"point", "P", "the design point to judge (default: the best by the goal)"}}},
          "judge a study by the goal in its manifest",
          judge_help,
          judge};
}

}  // namespace zerocount::commands
