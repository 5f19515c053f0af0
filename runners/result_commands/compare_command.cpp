#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/comparison/comparison.hpp"
#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/text.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/reading/study_file.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/command_line/output_place.hpp"
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
    "  worse, better  significantly (false discovery rate controlled over all measures and\n"
    "                 points), and by more than its margin\n"
    "  equivalent     the bounds of the change are within the margin, both ways\n"
    "  not worse      only the bound on the worse side is within it\n"
    "  undecided      otherwise; the number of trials that would decide is printed\n"
    "Exit code 1 if a measure is worse, 3 if one is undecided, otherwise 0. With --changed-fails\n"
    "a measure that is better gives exit code 1 too, and only equivalent measures pass.\n"
    "The manifests may differ, for example in a gain: points are matched by label.\n"
    "\n"
    "Margins and absolute requirements are given in a YAML file; missing ones have defaults\n"
    "(analysis/comparison/README.md):\n"
    "  fail_on: changed                 # as --changed-fails\n"
    "  margins: {success_rate: 0.01, settling_time: {relative: 0.05, absolute: 1.0e-3}}\n"
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

/// An output format of the comparison, and the option that names a file for it.
struct ComparisonForm {
  std::string_view name;
  std::string (*text)(const comparison::StudyComparison&);
};

constexpr std::array<ComparisonForm, 4> forms{{{"table", comparison::comparison_table},
                                               {"json", comparison::comparison_json},
                                               {"junit", comparison::comparison_junit},
                                               {"markdown", comparison::comparison_markdown}}};

/// Destination of one output format.
struct FormPlace {
  const ComparisonForm& form;
  std::filesystem::path place;
};

/// Destinations of all formats. The format of --format goes to standard output, unless another format does.
std::vector<FormPlace> places_of(const command_line::Arguments& arguments,
                                 const std::optional<std::string>& margins) {
  const std::string format = arguments.choice("format");
  std::vector<std::filesystem::path> inputs{arguments.operands().begin(), arguments.operands().end()};
  if (margins) inputs.emplace_back(*margins);
  std::vector<std::filesystem::path> outputs;
  if (arguments.has("format")) outputs.emplace_back("-");
  std::vector<FormPlace> places;
  for (const ComparisonForm& form : forms) {
    if (form.name == "table") continue;
    const std::optional<std::filesystem::path> place = command_line::text_place(arguments, form.name);
    if (!place) continue;
    places.push_back({form, *place});
    outputs.push_back(*place);
  }
  command_line::require_places(arguments, inputs, outputs);
  const bool taken = std::any_of(places.begin(), places.end(), [](const FormPlace& place) {
    return yaml::is_standard_stream(place.place);
  });
  const ComparisonForm& printed = *std::ranges::find(forms, format, &ComparisonForm::name);
  if (!taken) places.push_back({printed, "-"});
  return places;
}

/// The two design points of the only operand.
comparison::StudyComparison compare_points(const command_line::Arguments& arguments,
                                           const comparison::CompareOptions& options) {
  if (arguments.operands().size() > 1) arguments.refuse("option '--points' needs a single FILE");
  const reading::StudyFile file(arguments.operands()[0]);
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
  const std::vector<FormPlace> places = places_of(arguments, margins);
  comparison::CompareOptions options;
  if (margins) options.margins = *margins;
  options.changed_fails = arguments.has("changed-fails");
  options.max_trials = arguments.whole_number("max-trials", 1, std::int64_t{1} << 53);
  const comparison::StudyComparison result = compared(arguments, options);
  for (const FormPlace& place : places) {
    if (place.form.name == "table") {
      standard_output::write_fitted(place.form.text(result));
    } else {
      command_line::write_text(place.place, place.form.text(result));
    }
  }
  return code_of(result.verdict);
}

}  // namespace

commands::Command compare_command() {
  return {{"compare",
           "BASELINE FILE",
           {{"points", "A B", "compare two design points of one FILE, by label or number", false, 2},
            {"margins", "FILE", "YAML file of margins and requirements"},
            {"changed-fails", "", "a change for the better fails too, not only one for the worse"},
            {"max-trials", "N",
             "judge the first N trials of each point, at least one of every rig (default: a million moves)"},
            command_line::format_option({"table", "json", "junit", "markdown"}, "of standard output"),
            {"json", "FILE", "write the JSON there too"},
            {"junit", "FILE", "write JUnit XML there too"},
            {"markdown", "FILE", "write the Markdown summary there too"},
            command_line::force_option()},
           1,
           2},
          "compare a results file with a baseline: the regression gate",
          compare_help,
          compare};
}

}  // namespace zerocount::result_commands
