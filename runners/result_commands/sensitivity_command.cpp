#include <string>

#include <fmt/format.h>

#include "analysis/report/figures/answer_figures.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/status/status.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* sensitivity_help =
    "Prints which random parameters influence an output of the trials, with bounds, for each\n"
    "design point. For a study with design: saltelli by first-order and total Sobol' indices; for\n"
    "other designs by first-order indices estimated from the given trials, rank correlations and\n"
    "partial rank correlations, and for binary outputs also by a logistic fit. Parameters that\n"
    "do not vary are only listed.\n"
    "\n"
    "Outputs of a trial (the first two of a study with a goal):\n";

constexpr const char* examples =
    "\n"
    "If nothing can be estimated, for example because all trials succeed, the exit code is 3.\n"
    "\n"
    "Example: zerocount sensitivity gains.h5 --point 1 --output success --output jerk_count\n";

std::string full_help() {
  std::string text = sensitivity_help;
  const goal::Question with_goal{.parts = {{.goal = study::Goal{}}}};
  for (const sensitivity::SensitivityOutput& output :
       sensitivity::sensitivity_outputs(layout::measure_table(), with_goal)) {
    text += fmt::format("  {:<15} {}{}\n", output.name,
                        parameters::text_on(parameters::AxisKind::rotary, output.meaning),
                        output.unit == "1" ? "" : fmt::format(", {}", output.unit));
  }
  return text + examples;
}

ExitCode print_sensitivity(const command_line::Arguments& arguments) {
  sensitivity::SensitivityQuestion question;
  const reading::AllTrialsFile file(arguments.operands()[0]);
  question.points = command_line::point_options(arguments, file.point_labels());
  question.outputs = arguments.values("output");
  question.confidence =
      command_line::probability_option(arguments, "confidence").value_or(question.confidence);
  question.max_trials =
      arguments.whole_number("max-trials", 100, std::int64_t{1} << 53).value_or(question.max_trials);
  const sensitivity::StudySensitivity sensitivity = [&] {
    commands::StageProgress progress("zerocount sensitivity", /*quiet=*/false);
    progress.enter("reading trials");
    question.progress = [&](std::int64_t done, std::int64_t all) {
      progress.enter(fmt::format("{} of {} outputs", done, all));
    };
    return sensitivity::study_sensitivity(file, question);
  }();
  const ExitCode code = sensitivity::any_estimated(sensitivity) ? ExitCode::success : ExitCode::inconclusive;
  return answers::print(arguments, report::sensitivity_answer().of(sensitivity, code));
}

}  // namespace

commands::Command sensitivity_command() {
  return {{"sensitivity",
           "FILE",
           {{"point,p", "P", "design point, by label or number; may be repeated (default: all)", true},
            {"output", "NAME", "output of the trials; may be repeated (default: the first two)", true},
            {"confidence", "C", "confidence of the bounds, above 0 and up to 0.999 (default 0.95)"},
            {"max-trials", "N",
             "use the first N trials of each point (default 100000; of a saltelli design all are used)"},
            answers::format_option()}},
          "print which random parameters influence the outputs of the trials",
          full_help(),
          print_sensitivity,
          [] { return std::vector{report::sensitivity_answer().complete_type()}; }};
}

}  // namespace zerocount::result_commands
