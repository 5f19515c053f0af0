#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/pairs/history/database.hpp"
#include "analysis/pairs/history/run_record.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/page.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/storage/file_contents.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/status/status.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* history_help =
    "Results over time, in an SQLite database, which 'add' creates if it does not exist.\n"
    "\n"
    "history add FILE adds the measures of a results file that 'zerocount compare' judges (rates,\n"
    "settling times, numbers of jerks), at every point, with 95 % bounds. With --compare also the\n"
    "verdicts of a comparison of FILE with its baseline. A file is added only once. FILE.json, the\n"
    "answer of 'zerocount monitor --format json', adds the medians of the machine's measures.\n"
    "\n"
    "history show prints each series of values and where it changed: the runs and commits between\n"
    "which the change lies, and the run since which it is significant. Runs of a changed manifest\n"
    "are a new series; another seed or number of trials is not. Of a study with a goal only its\n"
    "measures are shown, unless --measure names another. The probability of a false alarm is stated\n"
    "below the table. The method, and the tables of the database:\n"
    "docs/history.md\n"
    "\n"
    "history plot draws the series: values with bounds, and the first run after each change.\n"
    "\n"
    "Example: zerocount history add gains.h5 --database history.sqlite\n"
    "         zerocount history show --database history.sqlite --point b --measure success_rate\n"
    "         zerocount history plot --database history.sqlite -o history.html\n";

std::filesystem::path database_of(const command_line::Arguments& arguments) {
  return arguments.value("database").value_or("history.sqlite");
}

/// How to wait while another process writes the database: a message is printed, so that the command does not
/// seem to hang.
history::Wait patience_with(const std::filesystem::path& database) {
  history::Wait wait;
  wait.notify = [database, seconds = wait.seconds] {
    status::tell("{}: another process is writing it; waiting for at most {:.0f} s\n", database.string(),
                 seconds);
  };
  return wait;
}

history::SeriesFilter filter_of(const command_line::Arguments& arguments) {
  return {arguments.value("study"), arguments.value("point"), arguments.value("measure")};
}

history::History history_shown(const command_line::Arguments& arguments) {
  const std::filesystem::path database = database_of(arguments);
  const std::vector<history::RunRecord> runs = history::read_runs(database, patience_with(database));
  return commands::with_progress("zerocount history", "testing for changes",
                                 [&] { return history::history_of(runs, filter_of(arguments)); });
}

ExitCode add(const command_line::Arguments& arguments) {
  if (arguments.operands().size() != 2) arguments.refuse("'history add' needs the results FILE to add");
  const std::filesystem::path database = database_of(arguments);
  const std::string file = arguments.operands()[1];
  std::optional<history::RunRecord> of_monitor = history::monitor_record(file);
  if (of_monitor && arguments.has("compare"))
    arguments.refuse("option '--compare': an answer of monitor is compared already; expected a results file");
  const auto say_already_there = [&] {
    status::tell("{}: already in {}, nothing to do\n", file, database.string());
    return ExitCode::success;
  };
  history::RunRecord run;
  if (of_monitor) {
    run = std::move(*of_monitor);
  } else {
    const reading::AllTrialsFile results(file);
    // The statistics of a large file take long. Its checksum tells whether they are needed.
    if (!arguments.has("compare") &&
        history::has_run(database, storage::recorded_checksum(results.path()), patience_with(database)))
      return say_already_there();
    run = commands::with_progress("zerocount history", "computing statistics",
                                  [&] { return history::record_of(results); });
  }
  if (const auto json = arguments.value("compare")) history::add_comparison(run, *json);
  switch (history::add_run(database, run, patience_with(database))) {
    case history::Addition::added:
      status::tell("{}: added to {}\n", file, database.string());
      break;
    case history::Addition::already_there:
      return say_already_there();
    case history::Addition::comparison_added:
      status::tell("{}: already in {}; added its comparison\n", file, database.string());
      break;
  }
  return ExitCode::success;
}

ExitCode show(const command_line::Arguments& arguments) {
  return answers::print(arguments, report::history_answer().of(history_shown(arguments)));
}

ExitCode plot_history(const command_line::Arguments& arguments) {
  arguments.required("output");
  const std::filesystem::path output = *command_line::text_place(arguments, "output");
  const commands::DrawingKind kind = commands::drawing_kind(arguments, "output", output);
  const history::History shown = history_shown(arguments);
  if (kind != commands::DrawingKind::page && shown.series.size() > 1)
    arguments.refuse(
        fmt::format("a picture shows one series, but {} are selected; choose with --study, --point and "
                    "--measure, or write a page (.html)",
                    shown.series.size()));
  command_line::write_text(output, commands::with_progress("zerocount history", "drawing", [&] {
                             return commands::drawing(report::answer_page(report::history_answer().of(shown)),
                                                      kind);
                           }));
  return ExitCode::success;
}

/// An action of the command `history`, such as adding results, with its name and function.
struct HistoryAction {
  std::string_view name;
  ExitCode (*run)(const command_line::Arguments&);
};

std::vector<HistoryAction> actions() {
  return {{"add", add}, {"show", show}, {"plot", plot_history}};
}

std::vector<std::string> names_of(const std::vector<HistoryAction>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const HistoryAction& action : all) names.emplace_back(action.name);
  return names;
}

ExitCode run_history(const command_line::Arguments& arguments) {
  const std::vector<HistoryAction> all = actions();
  const std::string& name = arguments.operands()[0];
  const auto action = std::ranges::find(all, name, &HistoryAction::name);
  if (name != "add" && arguments.operands().size() > 1)
    arguments.refuse(fmt::format("'history {}' takes no file; name the history with --database", name));
  return action->run(arguments);
}

}  // namespace

commands::Command history_command() {
  return {{"history",
           "add FILE | show | plot -o PLOT",
           {command_line::renewed_file({"database", "DB", "the history (default: history.sqlite)"}),
            command_line::of_operands(
                {"add"}, command_line::read_file(
                             {"compare", "FILE",
                              "add: the output of 'zerocount compare --json FILE' for the results file"})),
            command_line::of_operands({"show", "plot"}, {"study", "NAME", "only this study"}),
            command_line::of_operands({"show", "plot"}, {"point", "LABEL", "only this design point"}),
            command_line::of_operands({"show", "plot"},
                                      {"measure", "NAME", "only this measure, such as success_rate"}),
            command_line::of_operands({"show"}, answers::format_option()),
            command_line::of_operands(
                {"plot"}, command_line::written_file(
                              {"output,o", "PLOT",
                               "plot: a page of all series (*.html), or one series as *.svg or *.png"})),
            command_line::of_operands({"plot"}, command_line::force_option())},
           1,
           2,
           names_of(actions())},
          "results over time, with the runs at which they changed",
          history_help,
          run_history,
          [] { return std::vector{report::history_answer().complete_type()}; }};
}

}  // namespace zerocount::result_commands
