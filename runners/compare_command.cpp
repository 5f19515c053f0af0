#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/comparison/compare_studies.hpp"
#include "analysis/comparison/comparison_report.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/commands.hpp"
#include "runners/output_place.hpp"

namespace zerocount {
namespace {

constexpr const char* compare_help =
    "The regression gate: is FILE as good as BASELINE? Every design point is judged by its rates\n"
    "of success, arrival and stability, its settling times and its jerks.\n"
    "\n"
    "One study by one build must give data equal to the bit. Where trial i drew the same\n"
    "random numbers in both, trials are compared one by one; otherwise distributions are.\n"
    "A measure fails where it is significantly worse (false discoveries controlled over all\n"
    "measures and points) and by more than its margin; it passes where it is shown to be worse\n"
    "by less than the margin; otherwise it is inconclusive, with the number of trials that\n"
    "would decide. The manifests may differ, as in a gain: points are matched by label.\n"
    "\n"
    "Margins and absolute requirements stand in a YAML file; what it leaves out has defaults\n"
    "(analysis/comparison/README.md):\n"
    "  margins: {success_rate: 0.01, settling_time: {relative: 0.05, absolute: 1.0e-3}}\n"
    "  require: success_rate ≥ 0.995\n"
    "  points: {b: {success_rate: 0.05}}\n"
    "\n"
    "Example: zerocount compare baseline.h5 new.h5 --margins gate.yaml --junit gate.xml\n";

ExitCode code_of(GateVerdict verdict) {
  if (verdict == GateVerdict::passed) return ExitCode::success;
  return verdict == GateVerdict::regression ? ExitCode::regression : ExitCode::inconclusive;
}

void write_where_asked(const Arguments& arguments, const char* option, const std::string& text) {
  if (const std::optional<std::string> path = arguments.value(option)) replace_file(*path, text);
}

void protect(const Arguments& arguments, const std::optional<std::string>& margins) {
  std::vector<std::filesystem::path> inputs{arguments.operands()[0], arguments.operands()[1]};
  if (margins) inputs.emplace_back(*margins);
  std::vector<std::filesystem::path> outputs;
  for (const char* const option : {"json", "junit", "markdown"}) {
    if (const std::optional<std::string> path = arguments.value(option)) outputs.emplace_back(*path);
  }
  protect_from_outputs(arguments, inputs, outputs);
}

ExitCode compare(const Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"table", "json", "junit", "markdown"});
  const std::optional<std::string> margins = arguments.value("margins");
  protect(arguments, margins);
  const StudyComparison result =
      compare_files(arguments.operands()[0], arguments.operands()[1],
                    margins ? std::optional<std::filesystem::path>(*margins) : std::nullopt);
  write_where_asked(arguments, "json", comparison_json(result));
  write_where_asked(arguments, "junit", comparison_junit(result));
  write_where_asked(arguments, "markdown", comparison_markdown(result));
  if (format == "table") fmt::print("{}", comparison_table(result));
  if (format == "json") fmt::print("{}", comparison_json(result));
  if (format == "junit") fmt::print("{}", comparison_junit(result));
  if (format == "markdown") fmt::print("{}", comparison_markdown(result));
  return code_of(result.verdict);
}

}  // namespace

Command compare_command() {
  return {{"compare",
           "BASELINE FILE",
           2,
           2,
           {{"margins", "FILE", "YAML file of margins and requirements"},
            {"format", "FORMAT", "of standard output: table (default), json, junit or markdown"},
            {"json", "FILE", "write the JSON there too"},
            {"junit", "FILE", "write JUnit XML there too"},
            {"markdown", "FILE", "write the Markdown summary there too"}}},
          "compare a results file with a baseline: the regression gate",
          compare_help,
          compare};
}

}  // namespace zerocount
