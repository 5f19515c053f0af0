#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary/judged_point.hpp"
#include "analysis/summary/shown_points.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/worlds/learning.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::result_commands {
namespace {

using Json = nlohmann::ordered_json;

constexpr double usual_precision = 0.1;
constexpr double significance = 0.05;

constexpr const char* learn_help =
    "Says what to do next about the unknowns of a study with worlds: it gives the verdict of 'zerocount\n"
    "judge', and what follows from it. If a world is the truth and the unknown were measured to ±10 %\n"
    "(--precision), the worlds near its value remain possible, at least the four nearest. Where all\n"
    "of them meet the goal, or all fall short of it, the measurement decides. Each world is judged by\n"
    "the others, so that a measurement may misjudge it. Where few worlds fall short, any unknown\n"
    "decides most of them: 'by chance' is the probability of as many if the unknowns did not matter.\n"
    "Beside the unknowns it tests what follows from those of the friction, such as the extension at\n"
    "which creep ends. What decides need not be the cause.\n"
    "Without a goal, worlds fall short that are shown to succeed less often than the median world.\n"
    "The last column names the record of 'zerocount identify' that tells the unknown;\n"
    "'zerocount experiment' designs it.\n"
    "The exit code is 3 if these trials are too few: the goal is undecided, and no unknown is named.\n"
    "\n"
    "Example: zerocount learn unknown-friction.h5\n"
    "         zerocount learn unknown-friction.h5 --point 2 --precision 0.05 --format json\n";

/// What to do next.
enum class Next {
  nothing,      ///< the goal is met in every world
  change_axis,  ///< it is missed in every world
  more_trials,  ///< these trials show no difference between the worlds, and do not decide the goal
  measure,      ///< Answer::best()
  no_single     ///< worlds differ, but no single measurement is shown to tell them apart
};

struct Answer {
  const summary::StudySummary& summary;
  summary::ChosenPoint chosen;
  std::optional<summary::JudgedPoint> judged;  ///< of a study with a goal
  double precision;
  worlds::PointWorlds worlds;
  std::vector<worlds::Learned> learned{};

  const std::vector<worlds::WorldInput>& inputs() const {
    return summary::world_inputs_of(summary, chosen.point);
  }
  std::size_t bad() const {
    return static_cast<std::size_t>(std::count(worlds.bad.begin(), worlds.bad.end(), true));
  }
  bool worlds_differ() const { return bad() > 0 && bad() < worlds.bad.size(); }
  /// The measurement that decides most, of those that are shown to decide more than chance.
  const worlds::Learned* best() const {
    const auto found =
        std::ranges::find_if(learned, [](const worlds::Learned& one) { return one.p_value <= significance; });
    return found == learned.end() ? nullptr : &*found;
  }
  /// Worlds of which the verdict says this; none without a goal.
  std::size_t worlds_that(goal::Status status) const {
    return judged ? goal::worlds_that(status, judged->verdict).size() : 0;
  }
};

Next next_of(const Answer& answer) {
  const std::size_t all = answer.worlds.bad.size();
  if (answer.judged && answer.judged->verdict.status == goal::Status::met) return Next::nothing;
  if (answer.worlds_that(goal::Status::missed) == all) return Next::change_axis;
  if (!answer.worlds_differ()) return Next::more_trials;
  return answer.best() != nullptr ? Next::measure : Next::no_single;
}

std::string_view word_of(Next next) {
  switch (next) {
    case Next::nothing:
      return "nothing";
    case Next::change_axis:
      return "change_axis";
    case Next::more_trials:
      return "more_trials";
    case Next::measure:
      return "measure";
    case Next::no_single:
      break;
  }
  return "no_single_measurement";
}

std::string percent_of(std::int64_t count, std::size_t worlds) {
  return text::percentage(count, static_cast<std::int64_t>(worlds));
}

std::string table_of(const Answer& answer) {
  const std::size_t worlds = answer.worlds.bad.size();
  std::vector<text::TextColumn> columns{
      {"unknown", false, {}},  {"decided", true, {}}, {"meets it", true, {}},  {"falls short", true, {}},
      {"misjudged", true, {}}, {"open", true, {}},    {"by chance", true, {}}, {"record", false, {}}};
  for (const worlds::Learned& one : answer.learned) {
    const std::string_view record = worlds::record_of(answer.inputs()[one.input].name);
    columns[0].cells.push_back(answer.inputs()[one.input].name);
    columns[1].cells.push_back(percent_of(one.decided(), worlds));
    columns[2].cells.push_back(std::to_string(one.decided_good));
    columns[3].cells.push_back(std::to_string(one.decided_bad));
    columns[4].cells.push_back(std::to_string(one.misjudged));
    columns[5].cells.push_back(std::to_string(one.open));
    columns[6].cells.push_back(fmt::format("{:.2g}", one.p_value));
    columns[7].cells.emplace_back(record.empty() ? "none of identify" : record);
  }
  return text::aligned_table(columns);
}

/// Where some worlds are undecided, the table takes them by their observed rates.
std::string undecided_worlds_text(const Answer& answer) {
  const std::size_t undecided = answer.worlds_that(goal::Status::undecided);
  if (undecided == 0) return "";
  return fmt::format(
      "{} of {} worlds are undecided, and count by their observed rates here; more trials decide them\n",
      undecided, answer.worlds.bad.size());
}

std::string meanings_text(const Answer& answer) {
  std::string text;
  for (const worlds::WorldInput& input : answer.inputs()) {
    if (input.is_derived()) text += fmt::format("{} ({}): {}\n", input.name, input.unit, input.meaning);
  }
  return text.empty() ? text : text + '\n';
}

std::string next_text(const Answer& answer) {
  const std::size_t all = answer.worlds.bad.size();
  switch (next_of(answer)) {
    case Next::nothing:
      return "no measurement is needed: the goal is met in every world, whatever the truth is within what "
             "the manifest states\n";
    case Next::change_axis:
      return "no measurement of these unknowns helps: the goal is missed in every world; other gains or "
             "another axis may meet it\n";
    case Next::more_trials:
      if (!answer.judged)
        return "these trials show no difference between the worlds: more trials may, and a goal says what "
               "is to be decided\n";
      return fmt::format(
          "first more trials, then a measurement: {} of {} worlds are undecided, and {} fall short by their "
          "observed rates, so that no difference between worlds is seen that a measurement could tell\n",
          answer.worlds_that(goal::Status::undecided), all,
          answer.bad() == 0 ? std::string("none") : fmt::format("all {}", all));
    case Next::measure: {
      const worlds::Learned& best = *answer.best();
      return fmt::format("measure {}: it decides {} of {} worlds, and misjudges {}\n",
                         answer.inputs()[best.input].name, best.decided(), all, best.misjudged);
    }
    case Next::no_single:
      break;
  }
  return fmt::format(
      "no single measurement is shown to decide more than chance does (at a significance of {}); more "
      "worlds, or more trials in each, may show one\n",
      text::percent(significance));
}

/// The paragraph of `judge`; without a goal the worlds that fall short.
std::string verdict_text(const Answer& answer) {
  if (answer.judged) return summary::judgement_text(answer.summary, *answer.judged);
  return fmt::format("{}: {}\n",
                     summary::point_names(answer.summary)[static_cast<std::size_t>(answer.chosen.point)],
                     summary::bad_worlds_sentence(answer.worlds, answer.inputs(), false));
}

std::string text_of(const Answer& answer) {
  std::string text = verdict_text(answer) + "\n";
  if (!answer.learned.empty())
    text += fmt::format("if one unknown were measured to ±{}:\n\n{}\n{}{}", text::percent(answer.precision),
                        table_of(answer), meanings_text(answer), undecided_worlds_text(answer));
  return text + next_text(answer);
}

Json needed_json(const Answer& answer) {
  if (!answer.judged || !answer.judged->needs || answer.judged->needs->trials == 0) return {};
  return {{"rigs", answer.judged->needs->rigs}, {"trials", answer.judged->needs->trials}};
}

Json json_of(const Answer& answer) {
  Json unknowns = Json::array();
  for (const worlds::Learned& one : answer.learned) {
    const worlds::WorldInput& input = answer.inputs()[one.input];
    const std::string_view record = worlds::record_of(input.name);
    unknowns.push_back({{"parameter", input.name},
                        {"unit", input.unit},
                        {"derived", input.is_derived() ? Json(input.meaning) : Json()},
                        {"decided", one.decided()},
                        {"decided_good", one.decided_good},
                        {"decided_bad", one.decided_bad},
                        {"misjudged", one.misjudged},
                        {"open", one.open},
                        {"p_value", one.p_value},
                        {"record", record.empty() ? Json() : Json(record)}});
  }
  const Next next = next_of(answer);
  return {{"point", answer.chosen.point},
          {"label", answer.summary.labels[static_cast<std::size_t>(answer.chosen.point)]},
          {"status", answer.judged ? Json(goal::text_of(answer.judged->verdict.status)) : Json()},
          {"worlds", answer.worlds.bad.size()},
          {"bad", answer.bad()},
          {"undecided", answer.worlds_that(goal::Status::undecided)},
          {"needed", needed_json(answer)},
          {"next", word_of(next)},
          {"measure", next == Next::measure ? Json(answer.inputs()[answer.best()->input].name) : Json()},
          {"precision", answer.precision},
          {"unknowns", std::move(unknowns)}};
}

[[noreturn]] void refuse_equal_worlds(const std::string& path) {
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: nothing differs between worlds in this study; expected worlds: 30, and a value "
                  "such as friction.alpha: {{interval: [0.1, 2.0]}}",
                  path));
}

/// Refuses what the description of the file tells, before its trials are read.
void require_worlds(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  const study::Study study = commands::described_study(path);
  command_line::point_option(arguments, study.point_labels);
  if (study.worlds == 0) refuse_equal_worlds(path);
  if (study.open_loop) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: no move of an open-loop study is judged; expected a study with targets", path));
  }
}

Answer answer_to(const command_line::Arguments& arguments, const summary::StudySummary& summary) {
  const auto asked = command_line::point_option(arguments, summary.labels);
  const summary::ChosenPoint chosen = summary::choose_point(summary, asked);
  if (summary::world_inputs_of(summary, chosen.point).empty()) refuse_equal_worlds(arguments.operands()[0]);
  Answer answer{
      .summary = summary,
      .chosen = chosen,
      .judged = {},
      .precision = command_line::probability_option(arguments, "precision").value_or(usual_precision),
      .worlds =
          *summary::worlds_of_point(summary, chosen.point, static_cast<std::size_t>(chosen.chosen_from))};
  if (summary.goal) answer.judged = summary::judge_point(summary, chosen);
  if (answer.worlds_differ())
    answer.learned =
        worlds::what_to_learn(answer.inputs(), answer.worlds.bad, answer.precision, summary.seed);
  return answer;
}

/// Inconclusive where the goal is undecided and no unknown is named.
ExitCode exit_code_after(const Answer& answer) {
  const bool undecided = answer.judged && answer.judged->verdict.status == goal::Status::undecided;
  switch (next_of(answer)) {
    case Next::nothing:
    case Next::change_axis:
    case Next::measure:
      break;
    case Next::more_trials:
      return ExitCode::inconclusive;
    case Next::no_single:
      if (undecided) return ExitCode::inconclusive;
      break;
  }
  return ExitCode::success;
}

ExitCode learn(const command_line::Arguments& arguments) {
  require_worlds(arguments);
  const summary::StudySummary summary = summary::summarise_file(arguments.operands()[0]);
  const Answer answer = answer_to(arguments, summary);
  if (arguments.choice("format") == "json") {
    standard_output::write(text::json_text(json_of(answer)));
  } else {
    standard_output::write_fitted(text_of(answer));
  }
  return exit_code_after(answer);
}

}  // namespace

commands::Command learn_command() {
  return {{"learn",
           "FILE",
           {command_line::format_option({"text", "json"}),
            {"point", "P", "the design point (default: the best)"},
            {"precision", "R", "relative error of the measurement, 0 to 1 (default 0.1)"}}},
          "say which unknown to measure next",
          learn_help,
          learn};
}

}  // namespace zerocount::result_commands
