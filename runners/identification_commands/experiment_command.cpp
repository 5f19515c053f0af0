#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/record/experiment_design/experiment_design.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/page.hpp"
#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "experiments/study/setting_study.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/identification_commands/identification_commands.hpp"

namespace zerocount::identification_commands {
namespace {

constexpr const char* experiment_help =
    "Designs the material test of an axis: the torque (force) over time to command open loop, so that\n"
    "'zerocount identify' can tell the friction, the damping and the inertia from the record. The\n"
    "manifest has rough guesses; the wider the distributions, the more careful the test. Pulses, ramps\n"
    "with reversals and holds are chosen so that the parameters come out as narrow as possible for\n"
    "this encoder, its noise and this converter, on machines drawn from the manifest, among the\n"
    "protocols that are safe on all of them: none breaks away, none travels beyond --travel.\n"
    "\n"
    "The answer is the intervals to expect, by identifying a simulated record of the machine with\n"
    "the median of every guess, and what cannot be told from it. Beside them is how wide they\n"
    "are over the drawn machines, by the linear theory.\n"
    "\n"
    "-o writes the torque as a table (t, torque or force, DAC code). After the test add a column of\n"
    "counts, and it is a record for identify. --streamer writes one torque per line, for LinuxCNC's\n"
    "'loadrt streamer cfg=f' in a thread of the sample rate. The contact must be unloaded and virgin\n"
    "at the first sample: let the axis slide, and set the torque to 0.\n"
    "\n"
    "If the guesses are far off, put the fragment that identify writes in their place, and design\n"
    "a second experiment.\n"
    "\n"
    "Example: zerocount experiment my-axis.yaml -o torque.csv --streamer torque.txt\n";

double positive_option(const command_line::Arguments& arguments, const std::string& option, double usual,
                       double most, std::string_view expected) {
  const std::optional<std::string> text = arguments.value(option);
  if (!text) return usual;
  const std::optional<double> number = text::parse_number<double>(*text);
  if (!number || !(*number > 0.0) || !(*number <= most))
    arguments.refuse(fmt::format("option '--{}': '{}' is not {}", option, *text, expected));
  return *number;
}

/// Reads the option --budget of the search for an experiment: a number of protocols, or a time.
void read_budget(const command_line::Arguments& arguments, experiment_design::SearchSettings& search) {
  const command_line::Budget budget = command_line::budget_option(arguments);
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  if (budget.trials) search.max_protocols = static_cast<int>(std::min(*budget.trials, most));
  if (!budget.seconds) return;
  search.max_protocols = static_cast<int>(most);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(*budget.seconds);
  search.go_on = [end](int) { return std::chrono::steady_clock::now() < end; };
}

/// Paths of the files that the command writes besides standard output; nothing: the file is not written.
struct ExperimentOutputs {
  std::optional<std::filesystem::path> protocol;
  std::optional<std::filesystem::path> streamer;
  std::optional<std::filesystem::path> record;
  std::optional<std::filesystem::path> plot;
  commands::DrawingKind plot_kind{commands::DrawingKind::page};
};

ExperimentOutputs experiment_outputs(const command_line::Arguments& arguments) {
  const auto place = [&](const char* option) { return command_line::text_place(arguments, option); };
  ExperimentOutputs outputs{place("output"), place("streamer"), place("record"), place("plot")};
  if (outputs.plot) outputs.plot_kind = commands::drawing_kind(arguments, "plot", *outputs.plot);
  return outputs;
}

study::Study experiment_study(const command_line::Arguments& arguments) {
  study::Study study = commands::load_study(arguments.operands()[0], arguments);
  if (study.settings.empty()) return study;
  const std::optional<std::string> condition = arguments.value("condition");
  if (!study.settings.ages.at.empty())
    return study::in_setting(
        study, study::setting_named(study, condition, command_line::number_option(arguments, "age", 0.0)));
  if (condition) return study::in_setting(study, study::setting_labelled(study, *condition));
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: it has the conditions {}, and a record is made under one of them; expected "
                            "--condition with its name",
                            arguments.operands()[0], fmt::join(study::labels_of(study.settings), ", ")));
}

document::AnswerDescription<experiment_design::ExperimentDesign> experiment_answer() {
  document::AnswerDescription<experiment_design::ExperimentDesign> answer{
      {.name = "experiment",
       .meaning = "the record from which 'zerocount identify' estimates the friction",
       .csv_table = "parameters"},
      experiment_design::design_description()};
  answer.items.figures(
      [](const auto& design) { return std::vector<document::Figure>{report::experiment_figure(design)}; });
  return answer;
}

ExitCode experiment(const command_line::Arguments& arguments) {
  const ExperimentOutputs outputs = experiment_outputs(arguments);
  const study::Study study = experiment_study(arguments);
  experiment_design::DesignSettings settings;
  constexpr double longest = 3600.0;  // s
  settings.duration =
      positive_option(arguments, "duration", settings.duration, longest, "a duration of up to 3600 s");
  settings.max_torque = positive_option(arguments, "max-torque", settings.max_torque, 0.95,
                                        "a proportion of the breakaway torque, above 0 and up to 0.95");
  settings.max_travel = positive_option(arguments, "travel", settings.max_travel, settings.max_travel,
                                        "a positive travel, in rad or, on a linear axis, m");
  settings.machines = arguments.whole_number("machines", 1, 1000).value_or(settings.machines);
  settings.point = command_line::point_option(arguments, study.points.labels).value_or(0);
  read_budget(arguments, settings.search);
  const experiment_design::ExperimentDesign design = [&] {
    commands::StageProgress progress("zerocount experiment", arguments.has("quiet"));
    settings.report = [&](std::string_view stage) { progress.enter(stage); };
    return experiment_design::design_experiment(study, settings);
  }();
  if (outputs.protocol)
    command_line::write_text(*outputs.protocol, experiment_design::protocol_table(design));
  if (outputs.streamer)
    command_line::write_text(*outputs.streamer, experiment_design::streamer_file(design.protocol));
  if (outputs.record) command_line::write_text(*outputs.record, experiment_design::record_table(design));
  const bool any = std::ranges::any_of(design.parameters,
                                       [](const auto& parameter) { return is_estimated(parameter.found); });
  const document::Answer answer = experiment_answer().of(
      design, any && design.identification.checks.passed ? ExitCode::success : ExitCode::inconclusive);
  if (outputs.plot)
    command_line::write_text(*outputs.plot,
                             commands::drawing(report::answer_page(answer), outputs.plot_kind));
  return answers::print(arguments, answer);
}

}  // namespace

commands::Command experiment_command() {
  return {
      {"experiment",
       "MANIFEST",
       {command_line::written_file({"output,o", "FILE", "write the torque over time there, as CSV"}),
        command_line::written_file({"streamer", "FILE", "write the torque there for LinuxCNC's streamer"}),
        command_line::written_file(
            {"record", "FILE", "write the simulated record of the median machine there, as CSV"}),
        command_line::written_file(
            {"plot", "FILE", "draw the torque and the expected readings: a page (*.html), *.svg or *.png"}),
        {"duration", "S", "duration of the record (default 10)"},
        {"travel", "X", "largest distance from the start, rad or m (default: what breakaway allows)"},
        {"max-torque", "P", "largest torque, as a proportion of the breakaway torque (default 0.7)"},
        {"machines", "N", "machines drawn from the manifest (default 16)"},
        {"budget", "B", "protocols to try (default 80), or a time such as 30s"},
        {"point", "P", "design point, by label or number from 0 (default 0)"},
        {"condition", "NAME", "condition of the manifest under which the record is made"},
        {"age", "A", "age of the manifest at which the record is made"},
        {"set", "KEY=VALUE", "override a manifest key; may be repeated", true},
        answers::format_option(),
        {"quiet,q", "", "print no progress"},
        command_line::needing({"output", "streamer", "record", "plot"}, command_line::force_option())}},
      "design the torque over time from which identify estimates the friction",
      experiment_help,
      experiment,
      [] { return std::vector{experiment_answer().complete_type()}; }};
}

}  // namespace zerocount::identification_commands
