#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/pairs/history/database.hpp"
#include "analysis/report/report.hpp"
#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/live_page.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/result_commands/report_parts.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/progress.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* report_help =
    "Writes an HTML page about a results file: the conclusions in words, success at every point\n"
    "with bounds, stability maps with the criteria (6) and (7), settling times, jerks,\n"
    "sensitivity, the Bode plot of the open loop, the response of the median and the worst trial\n"
    "(simulated again), the figures of the paper that the study can reproduce, and the provenance.\n"
    "The page needs no other files and no network. It adapts to phones, to dark mode and to paper;\n"
    "print it from a browser for a PDF.\n"
    "\n"
    "With a baseline, the page also has the result of 'zerocount compare'. The exit code does\n"
    "not depend on that result. With a history, it has the earlier runs and when they changed.\n"
    "\n"
    "--with adds the answers of other commands on the study of the file at the chosen point: limits\n"
    "(what stands between it and the goal), worst (which machine it suits worst), learn (which\n"
    "unknown to measure), rare (how often a move fails that plain trials do not show). It tells first\n"
    "how long they take; --budget bounds them together. A part that has no answer says why. After\n"
    "Ctrl-C the page has the parts that are ready, and the exit code is 130.\n"
    "\n"
    "Of a FOLDER the page is an index of its results files: study, date, goal, verdict, and a link to\n"
    "the report of each, which is written beside the index unless there is one of the same contents.\n"
    "\n"
    "Examples:\n"
    "  zerocount report gains.h5 -o gains.html\n"
    "  zerocount report results -o results/index.html --force\n"
    "  zerocount report gains.h5 -o gains.html --with limits,worst --budget 2min\n";

constexpr const char* plot_help =
    "Draws one figure of the report as a file, for a paper: a picture or a specification of Vega-Lite\n"
    "with its data (*.json), for which it needs node, and for PNG also rsvg-convert (Debian: nodejs,\n"
    "librsvg2-bin); or a page (*.html). Without --figure it prints the names of the figures that this\n"
    "study has.\n"
    "\n"
    "Example: zerocount plot gains.h5 --figure success -o success.svg\n";

/// Earlier runs of the file's study in a history database; nothing if there are fewer than two.
history::History history_of_study(const std::filesystem::path& database, const reading::AllTrialsFile& file) {
  std::vector<history::RunRecord> runs = history::read_runs(database);
  const std::string series = history::series_sha256(file);
  std::erase_if(runs, [&](const history::RunRecord& run) { return run.series_sha256 != series; });
  return runs.size() < 2 ? history::History{} : history::history_of(runs);
}

report::StudyReport report_of(const command_line::Arguments& arguments, const reading::AllTrialsFile& file,
                              bool jerks = true) {
  report::ReportOptions options;
  options.jerks = jerks;
  options.point = command_line::point_option(arguments, file.point_labels());
  if (const auto baseline = arguments.value("baseline")) {
    comparison::CompareOptions compare;
    if (const auto margins = arguments.value("margins")) compare.margins = *margins;
    compare.changed_fails = arguments.has("changed-fails");
    options.comparison = comparison::compare_studies(reading::AllTrialsFile(*baseline), file,
                                                     comparison::rules_of(compare, file.point_labels()));
  }
  if (std::string margins = design_commands::tuned_margins(file); !margins.empty())
    options.tuning = {.first_screen = {.margins = std::move(margins)}};
  if (const auto database = arguments.value("history")) options.history = history_of_study(*database, file);
  return commands::verified_report(file, std::move(options));
}

/// Path of the output file. Its name must end in one of `extensions`.
std::filesystem::path picture_or_page(const command_line::Arguments& arguments,
                                      const std::vector<std::string>& extensions) {
  arguments.required("output");
  std::filesystem::path output = *command_line::text_place(arguments, "output");
  const std::string extension = output.extension().string();
  if (!yaml::is_standard_stream(output) &&
      std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
    arguments.refuse(fmt::format("option '--output': '{}' does not end in {}", output.string(),
                                 fmt::join(extensions, " or ")));
  }
  commands::require_page_place(arguments, output);
  return output;
}

/// Inserts the sections into a page, before the section about what was run, which stays the last one.
void add_parts(report::ReportPage& page, std::vector<report::PageSection> sections) {
  const auto last = std::ranges::find(page.sections, "run", &report::PageSection::name);
  page.sections.insert(last, std::make_move_iterator(sections.begin()),
                       std::make_move_iterator(sections.end()));
}

/// Runs `report FOLDER`: writes the index page of a folder of results files, and the pages of reports that it
/// needs.
ExitCode write_index(const command_line::Arguments& arguments, const std::filesystem::path& output) {
  for (const char* const option : {"with", "budget", "baseline", "history", "point"}) {
    if (arguments.has(option))
      arguments.refuse(
          fmt::format("option '--{}': applies to one results file; expected none with a folder", option));
  }
  const report::ReportPage index_page =
      folder_index(arguments.operands()[0], output,
                   [&](const std::filesystem::path& file, const std::filesystem::path& place) {
                     command_line::require_apart(arguments, place, {{output}});
                     commands::require_page_place(arguments, place);
                     const reading::AllTrialsFile results(file);
                     command_line::write_text(place, report::html_page(report_of(arguments, results).page));
                   });
  command_line::write_text(output, report::html_page(index_page));
  return ExitCode::success;
}

ExitCode write_report(const command_line::Arguments& arguments) {
  const std::filesystem::path output = picture_or_page(arguments, {".html", ".htm"});
  std::error_code error;
  if (std::filesystem::is_directory(arguments.operands()[0], error)) return write_index(arguments, output);
  const std::vector<std::string_view> parts = parts_option(arguments);
  const command_line::Budget budget = command_line::budget_option(arguments);
  // Without parts Ctrl-C ends the command at once.
  std::optional<status::InterruptionWatch> interruption;
  if (!parts.empty()) interruption.emplace();
  const std::stop_token stop = interruption ? interruption->token() : std::stop_token();
  const reading::AllTrialsFile file(arguments.operands()[0]);
  report::ReportPage page = report_of(arguments, file).page;
  add_parts(page, part_sections({file, command_line::point_option(arguments, file.point_labels())}, parts,
                                budget, stop));
  if (stop.stop_requested()) page.state = report::PageState::unfinished;
  command_line::write_text(output, report::html_page(page));
  return stop.stop_requested() ? ExitCode::interrupted : ExitCode::success;
}

/// Contents of the file that shows the figure, as the extension of its name asks: a picture or a page.
/// @param title title of a page
std::string figure_text(const report::Figure& figure, const std::string& title,
                        const std::string& extension) {
  if (extension == ".html") {
    report::ReportPage page;
    page.title = title;
    page.sections.emplace_back().figures = {figure};
    return report::html_page(page);
  }
  return commands::picture(figure, extension);
}

ExitCode plot(const command_line::Arguments& arguments) {
  const std::string input = arguments.operands()[0];
  if (!arguments.has("figure")) {
    const reading::AllTrialsFile file(input);
    for (const std::string& name : report::figure_names(report_of(arguments, file).page))
      standard_output::write(name + "\n");
    return ExitCode::success;
  }
  const std::filesystem::path output = picture_or_page(arguments, {".svg", ".png", ".html", ".json"});
  const reading::AllTrialsFile file(input);
  const std::string name = arguments.required("figure");
  report::ReportPage page = report_of(arguments, file, name.starts_with("jerk")).page;
  const std::vector<std::string> known = report::figure_names(page);
  if (std::ranges::find(known, name) == known.end()) page = report_of(arguments, file).page;  // all are named
  const report::Figure& figure = report::find_figure(page, name);
  command_line::write_text(output, figure_text(figure, page.title, output.extension().string()));
  return ExitCode::success;
}

std::vector<command_line::OptionSpec> with_part_options(std::vector<command_line::OptionSpec> own) {
  for (command_line::OptionSpec& option : part_options()) own.push_back(std::move(option));
  return own;
}

/// Options that the commands `report` and `plot` have in common.
/// @param own options of a single command, which come first
std::vector<command_line::OptionSpec> options_of_report(std::vector<command_line::OptionSpec> own) {
  own.insert(
      own.end(),
      {command_line::read_file({"baseline", "FILE", "compare with these results"}),
       command_line::needing(
           {"baseline"},
           command_line::read_file({"margins", "FILE", "the margins and requirements of that comparison"})),
       command_line::needing({"baseline"},
                             {"changed-fails", "", "in that comparison an improvement fails too"}),
       command_line::read_file(
           {"history", "DB", "show the earlier runs of the study in this history ('zerocount history')"}),
       {"point", "P", "design point whose trials are shown, by label or number (default: the best)"},
       command_line::needing({"output"}, command_line::force_option())});
  return own;
}

}  // namespace

commands::Command report_command() {
  return {{"report", "FILE | FOLDER",
           options_of_report(with_part_options({command_line::page_file(
               {"output,o", "PAGE",
                "the page to write, such as report.html; - is standard output (required)"})}))},
          "write one HTML page on a results file, or an index of a folder of them",
          report_help,
          write_report};
}

commands::Command plot_command() {
  return {
      {"plot", "FILE",
       options_of_report(
           {{"figure", "NAME", "name of the figure"},
            command_line::needing(
                {"figure"},
                command_line::page_file(
                    {"output,o", "PICTURE",
                     "the file to write: *.svg, *.png, *.html or *.json; - is standard output, as SVG"}))})},
      "draw one figure of the report",
      plot_help,
      plot};
}

}  // namespace zerocount::result_commands
