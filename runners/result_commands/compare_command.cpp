#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* compare_help =
    "The regression gate: is FILE as good as BASELINE? Every design point is judged by its rates\n"
    "of success, arrival and stability, its settling times and its jerks; where a manifest has a\n"
    "goal, by that alone: the moves and machines that meet it, and the settling time in its band.\n"
    "\n"
    "The same study run by the same build must give bitwise equal data. If trial i has the same\n"
    "random numbers in both files, trials are compared pairwise; otherwise distributions are\n"
    "compared. The verdict on a measure:\n"
    "  worse, better  a change beyond its margin is shown: a bound lies beyond it, and the test of\n"
    "                 a change within it rejects (false discovery rate controlled over all\n"
    "                 measures and points)\n"
    "  equivalent     the bounds of the change are within the margin, both ways\n"
    "  not worse      only the bound on the worse side is within it\n"
    "  undecided      otherwise, also where only the estimate lies beyond the margin; the number of\n"
    "                 trials that would decide is printed\n"
    "Exit code 1 if a measure is worse, 3 if one is undecided, otherwise 0. With --changed-fails\n"
    "a measure that is better gives exit code 1 too, and only equivalent measures pass.\n"
    "The manifests may differ, for example in a gain: points are matched by label, conditions by\n"
    "name. A point is compared under each of its conditions, and by each goal.\n"
    "\n"
    "Margins and absolute requirements are given in a YAML file; missing ones have defaults\n"
    "(docs/compare.md):\n"
    "  fail_on: changed                 # as --changed-fails\n"
    "  margins: {success_rate: 0.01, arrival_time: {relative: 0.05, absolute: 1.0e-3}}\n"
    "  require: success_rate ≥ 0.995\n"
    "  points: {b: {success_rate: 0.05}}\n"
    "\n"
    "With --points two design points of one file are compared: is the second as good as the first?\n"
    "\n"
    "Example: zerocount compare baseline.h5 new.h5 --margins gate.yaml --junit gate.xml\n"
    "         zerocount compare gains.h5 --points low high\n";

ExitCode code_of(comparison::GateVerdict verdict) {
  if (verdict == comparison::GateVerdict::passed) return ExitCode::success;
  return comparison::fails(verdict) ? ExitCode::regression : ExitCode::inconclusive;
}

/// A format of the answer, and the file to which it is written; standard output if the path is "-".
struct FormatPlace {
  std::string format;
  std::filesystem::path place;
};

/// Formats in which the answer is written, each with its destination. The format of --format goes to standard
/// output, unless another format does.
std::vector<FormatPlace> places_of(const command_line::Arguments& arguments) {
  std::vector<std::filesystem::path> printed;
  if (arguments.has("format")) printed.emplace_back("-");
  std::vector<FormatPlace> places;
  for (const char* const format : {"json", "junit", "markdown"}) {
    const std::optional<std::filesystem::path> place = command_line::text_place(arguments, format);
    if (!place) continue;
    command_line::require_apart(arguments, *place, printed);
    places.push_back({format, *place});
  }
  return places;
}

/// Comparison of the two design points that the options name, in the results file that is the only operand.
comparison::StudyComparison compare_points(const command_line::Arguments& arguments,
                                           const comparison::CompareOptions& options) {
  if (arguments.operands().size() > 1) arguments.refuse("option '--points' needs a single FILE");
  const reading::AllTrialsFile file(arguments.operands()[0]);
  const std::vector<std::string> labels = file.point_labels();
  const auto points = command_line::point_pair_option(arguments, "points", labels).value();
  if (points.first == points.second) {
    arguments.refuse(fmt::format("option '--points': both are the point {}; expected different points",
                                 text::printable(labels[static_cast<std::size_t>(points.first)])));
  }
  return comparison::compare_points(file, points.first, points.second, comparison::rules_of(options, labels));
}

comparison::StudyComparison compared(const command_line::Arguments& arguments,
                                     const comparison::CompareOptions& options) {
  if (arguments.has("points")) return compare_points(arguments, options);
  if (arguments.operands().size() < 2)
    arguments.refuse("BASELINE FILE expected, or one FILE with the option '--points'");
  return comparison::compare_files(arguments.operands()[0], arguments.operands()[1], options);
}

ExitCode compare(const command_line::Arguments& arguments) {
  const std::optional<std::string> margins = arguments.value("margins");
  const std::vector<FormatPlace> places = places_of(arguments);
  comparison::CompareOptions options;
  if (margins) options.margins = *margins;
  options.changed_fails = arguments.has("changed-fails");
  options.max_trials = arguments.whole_number("max-trials", 1, std::int64_t{1} << 53);
  const comparison::StudyComparison result = compared(arguments, options);
  const document::Answer answer = report::comparison_answer().of(result, code_of(result.verdict));
  const auto text_in = [&](const std::string& format) {
    return format == "junit" ? comparison::comparison_junit(result) : answers::rendered(answer, format);
  };
  for (const FormatPlace& one : places) command_line::write_text(one.place, text_in(one.format));
  if (std::ranges::any_of(places, yaml::is_standard_stream, &FormatPlace::place)) return answer.exit_code;
  if (arguments.choice("format") != "junit") return answers::print(arguments, answer);
  standard_output::write(text_in("junit"));
  return answer.exit_code;
}

}  // namespace

commands::Command compare_command() {
  return {
      {"compare",
       "BASELINE FILE",
       {{"points", "A B", "compare two design points of one FILE, by label or number", false, 2},
        command_line::read_file({"margins", "FILE", "YAML file of margins and requirements"}),
        {"changed-fails", "", "a change for the better fails too, not only one for the worse"},
        {"max-trials", "N",
         "judge the first N trials of each point, at least one of every machine (default: a million moves)"},
        answers::format_option({"junit"}),
        command_line::written_file({"json", "FILE", "write the JSON there too"}),
        command_line::written_file({"junit", "FILE", "write JUnit XML there too"}),
        command_line::written_file({"markdown", "FILE", "write the Markdown summary there too"}),
        command_line::force_option()},
       1,
       2},
      "compare a results file with a baseline: the regression gate",
      compare_help,
      compare,
      [] { return std::vector{report::comparison_answer().complete_type()}; }};
}

}  // namespace zerocount::result_commands
