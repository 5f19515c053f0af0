#include <cstdint>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "analysis/sensitivity/sensitivity.hpp"
#include "results/reading/study_file.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/commands.hpp"

namespace zerocount {
namespace {

constexpr const char* sensitivity_help =
    "Says which of the random parameters drive an output of the trials, with bounds, point by\n"
    "point: of a study with design: saltelli by Sobol' indices, first order and total; of any\n"
    "other by what its trials tell: the proportion of the variance that each parameter explains\n"
    "alone, rank correlations, and partial ones; of outputs that are yes or no also by a\n"
    "logistic fit. Parameters that do not vary are left out, and named.\n"
    "\n"
    "Outputs of a trial:\n";

constexpr const char* examples =
    "\n"
    "Where nothing at all can be estimated, say because all trials succeed, the exit code is 3.\n"
    "\n"
    "Example: zerocount sensitivity gains.h5 --point 1 --output success --output jerk_count\n";

std::string full_help() {
  std::string text = sensitivity_help;
  for (const SensitivityOutput& output : sensitivity_outputs()) {
    text += fmt::format("  {:<15} {}{}\n", output.name, output.meaning,
                        output.unit == "1" ? "" : fmt::format(", {}", output.unit));
  }
  return text + examples;
}

ExitCode print_sensitivity(const Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"table", "json", "csv"});
  SensitivityQuestion question;
  const StudyFile file(arguments.operands()[0]);
  question.points = point_options(arguments, file.point_labels());
  question.outputs = arguments.values("output");
  question.confidence = probability_option(arguments, "confidence").value_or(question.confidence);
  const StudySensitivity sensitivity = study_sensitivity(file, question);
  if (format == "table") fmt::print("{}", sensitivity_table(sensitivity));
  if (format == "json") fmt::print("{}", sensitivity_json(sensitivity));
  if (format == "csv") fmt::print("{}", sensitivity_csv(sensitivity));
  return any_estimated(sensitivity) ? ExitCode::success : ExitCode::inconclusive;
}

}  // namespace

Command sensitivity_command() {
  return {
      {"sensitivity",
       "FILE",
       1,
       1,
       {{"point,p", "P", "design point, by label or number; may be repeated (default: all)", true},
        {"output", "NAME", "output of the trials; may be repeated (default: success, settling_time)", true},
        {"confidence", "C", "confidence of the bounds, above 0 and up to 0.999 (default 0.95)"},
        {"format", "FORMAT", "table (default), json or csv"}}},
      "say which random parameters drive what the trials do",
      full_help(),
      print_sensitivity};
}

}  // namespace zerocount
