#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/worlds/learning.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/commands.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::commands {
namespace {

using Json = nlohmann::ordered_json;

constexpr double usual_precision = 0.1;
constexpr double significance = 0.05;

constexpr const char* learn_help =
    "Says which one unknown of a study with worlds to measure next. If a world is the truth and the\n"
    "unknown were measured to ±10 % (--precision), the worlds near its value remain possible, at\n"
    "least the four nearest. Where all of them meet the goal, or all fall short of it, the\n"
    "measurement decides. Each world is judged by the others, so that a measurement may misjudge\n"
    "it. Where few worlds fall short, any unknown decides most of them: 'by chance' is the\n"
    "probability of as many if the unknowns did not matter.\n"
    "Without a goal, worlds fall short that succeed less often than the median world.\n"
    "The last column names the record of 'zerocount identify' that tells the unknown;\n"
    "'zerocount experiment' designs it.\n"
    "\n"
    "Example: zerocount learn unknown-friction.h5\n"
    "         zerocount learn unknown-friction.h5 --point 2 --precision 0.05 --format json\n";

struct Question {
  const summary::StudySummary& summary;
  std::int64_t point;
  double precision;
  const worlds::PointWorlds& worlds;
  std::vector<worlds::Learned> learned;

  const std::vector<worlds::WorldInput>& inputs() const { return summary::world_inputs_of(summary, point); }
};

std::string percent_of(std::int64_t count, std::size_t worlds) {
  return text::percentage(count, static_cast<std::int64_t>(worlds));
}

std::string table_of(const Question& question) {
  const std::size_t worlds = question.worlds.bad.size();
  std::vector<text::TextColumn> columns{
      {"unknown", false, {}},  {"decided", true, {}}, {"meets it", true, {}},  {"falls short", true, {}},
      {"misjudged", true, {}}, {"open", true, {}},    {"by chance", true, {}}, {"record", false, {}}};
  for (const worlds::Learned& one : question.learned) {
    const std::string_view record = worlds::record_of(question.inputs()[one.input].name);
    columns[0].cells.push_back(question.inputs()[one.input].name);
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

std::string text_of(const Question& question) {
  const summary::StudySummary& summary = question.summary;
  std::string text =
      fmt::format("{}: {}\n", summary::point_names(summary)[static_cast<std::size_t>(question.point)],
                  summary::bad_worlds_sentence(question.worlds, question.inputs(), summary.goal.has_value()));
  const auto bad = std::count(question.worlds.bad.begin(), question.worlds.bad.end(), true);
  if (bad == 0 || bad == std::ssize(question.worlds.bad))
    return text + "the worlds are all of one kind: no measurement is needed to decide\n";
  text += fmt::format("\nif one unknown were measured to ±{}:\n\n{}\n", text::percent(question.precision),
                      table_of(question));
  const worlds::Learned& best = question.learned.front();
  if (best.p_value > significance) {
    return text +
           fmt::format(
               "no single measurement is shown to decide more than chance does (at a significance of {})\n",
               text::percent(significance));
  }
  return text + fmt::format("measure {}: it decides {} of {} worlds, and misjudges {}\n",
                            question.inputs()[best.input].name, best.decided(), question.worlds.bad.size(),
                            best.misjudged);
}

Json json_of(const Question& question) {
  const summary::StudySummary& summary = question.summary;
  Json unknowns = Json::array();
  for (const worlds::Learned& one : question.learned) {
    const std::string& name = question.inputs()[one.input].name;
    const std::string_view record = worlds::record_of(name);
    unknowns.push_back({{"parameter", name},
                        {"decided", one.decided()},
                        {"decided_good", one.decided_good},
                        {"decided_bad", one.decided_bad},
                        {"misjudged", one.misjudged},
                        {"open", one.open},
                        {"p_value", one.p_value},
                        {"record", record.empty() ? Json() : Json(record)}});
  }
  return {{"point", question.point},
          {"label", summary.labels[static_cast<std::size_t>(question.point)]},
          {"worlds", question.worlds.bad.size()},
          {"bad", std::count(question.worlds.bad.begin(), question.worlds.bad.end(), true)},
          {"precision", question.precision},
          {"unknowns", std::move(unknowns)}};
}

ExitCode learn(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  const summary::StudySummary summary = summary::summarise_file(path);
  const auto asked = command_line::point_option(arguments, summary.labels);
  const std::int64_t point = summary::choose_point(summary, asked).point;
  if (summary.worlds == 0 || summary::world_inputs_of(summary, point).empty()) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: nothing differs between worlds in this study; expected worlds: 30, and a value "
                    "such as friction.alpha: {{interval: [0.1, 2.0]}}",
                    path));
  }
  const std::optional<worlds::PointWorlds> worlds = summary::worlds_of_point(summary, point);
  if (!worlds) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: no move of an open-loop study is judged; expected a study with targets", path));
  }
  const double precision = command_line::probability_option(arguments, "precision").value_or(usual_precision);
  const Question question{
      summary, point, precision, *worlds,
      worlds::what_to_learn(summary::world_inputs_of(summary, point), worlds->bad, precision, summary.seed)};
  if (arguments.choice("format") == "json") {
    standard_output::write(text::json_text(json_of(question)));
  } else {
    standard_output::write_fitted(text_of(question));
  }
  return ExitCode::success;
}

}  // namespace

Command learn_command() {
  return {{"learn",
           "FILE",
           {command_line::format_option({"text", "json"}),
            {"point", "P", "the design point (default: the best)"},
            {"precision", "R", "relative error of the measurement, 0 to 1 (default 0.1)"}}},
          "say which unknown to measure next",
          learn_help,
          learn};
}

}  // namespace zerocount::commands
