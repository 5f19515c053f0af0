#include <filesystem>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "analysis/goal/question.hpp"
#include "analysis/parallel/parallel.hpp"
#include "analysis/report/embedded_files.hpp"
#include "analysis/report/page.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/command_line/output_place.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/figure_picture.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/plugins/hidden_state.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/engine_use.hpp"
#include "runners/study_run/interruption.hpp"
#include "runners/study_run/study_runner.hpp"
#include "runners/tuning/limits_text.hpp"
#include "runners/tuning/tune_text.hpp"
#include "runners/tuning/tuner.hpp"
#include "runners/tuning/tuning_page.hpp"
#include "runners/tuning/worst_in_box.hpp"
#include "runners/tuning/worst_text.hpp"

namespace zerocount::design_commands {
namespace {

constexpr const char* tune_help =
    "Finds values of the free parameters with which the axis meets its goal, and proves them on\n"
    "machines that the search never saw. The manifest needs a goal and a section tune:\n"
    "\n"
    "    goal: {band: 1, within: 0.05, moves: 0.99}\n"
    "    tune: {free: {controller.ki: {log: [5.0e+3, 3.0e+5]}, controller.kp: [0, 1000]},\n"
    "           minimise: band_settling_time.p95, margins: {gain: 6, phase: 30, delay: 0.5}}\n"
    "\n"
    "Of the values that meet the goal and keep the margins (dB, degrees, samples of delay), the\n"
    "search seeks those with the smallest criterion. Candidates race on the same machines; one\n"
    "that cannot win is dropped early. The bounds are of the proof alone. FILE is its results\n"
    "file, whose manifest has the tuned values.\n"
    "\n"
    "--budget bounds all together: the search, which takes half, the proof, and what follows it. It\n"
    "is a number of trials, with which the answer depends on the seed alone, or a time such as 60s\n"
    "or 5min. What it is not enough for is named. Without it the search takes 500000 trials, and the\n"
    "proof and the rest what they need.\n"
    "Ctrl-C keeps the simulated points; the same command goes on with them.\n"
    "The exit code is 0 if the goal is met, 1 if no values in the ranges meet it, 3 if the proof\n"
    "does not decide it.\n"
    "\n"
    "Example: zerocount tune my-axis.yaml -o tuned.h5\n";

constexpr const char* limits_help =
    "Tells what stands between a point and its goal: the rate of the goal with each cause of\n"
    "failures switched off alone, and with the best pair of causes: creep, the converter (16 times\n"
    "finer), the encoder (4 times finer), the sample rate (twice), delay and amplifier lag, noise,\n"
    "disturbance, missed and late samples. The gains are not tuned again. All are simulated with\n"
    "the same random numbers. Without a goal the rate is that of moves that end at zero counts. Of\n"
    "several points --point chooses one.\n"
    "\n"
    "Example: zerocount limits my-axis.yaml\n";

constexpr const char* worst_help =
    "Finds the machine that a gain suits worst: of the machines of the study, and in the box of the\n"
    "central 99.9 % of each quantity that differs between machines, where it is sought from the\n"
    "worst of the study, from the corners, and from points between them; then among the likely\n"
    "machines, whose normal scores have a sum of squares within the 99.9 % quantile. Each is judged\n"
    "by 256 trials of its own. -o writes the manifest of the worst machine of the box: its values\n"
    "are fixed, and `run` repeats these trials. Without a goal moves are to end at zero counts. Of\n"
    "several points --point chooses one.\n"
    "\n"
    "Example: zerocount worst my-axis.yaml -o worst.yaml\n";

ExitCode tune(const command_line::Arguments& arguments) {
  tuning::TuneSettings settings;
  settings.output = command_line::output_place(arguments);
  const study::Study study = commands::load_study(arguments.operands()[0], arguments, {&settings.output, 1});
  settings.threads = static_cast<int>(arguments.whole_number("threads", 1, 4096).value_or(0));
  settings.quiet = arguments.has("quiet");
  const command_line::Budget budget = command_line::budget_option(arguments);
  settings.budget = {budget.trials, budget.seconds};
  const bool json = arguments.choice("format") == "json";
  settings.force = arguments.has("force");
  const std::optional<std::filesystem::path> page = command_line::text_place(arguments, "report");
  if (page) {
    command_line::require_places(arguments, {arguments.operands()[0], settings.output}, {*page});
    if (commands::drawing_kind(arguments, "report", *page) != commands::DrawingKind::page)
      arguments.refuse(fmt::format("option '--report': '{}' does not end in .html", page->string()));
    report::require_drawing_libraries();
  }
  settings.maps = page.has_value();
  const parallel::ThreadLimit limit(study_run::threads_to_use(settings.threads));
  commands::print_warnings(study);
  const std::string engine = study_run::engine_text(study_run::points_on_reference(study));
  if (!engine.empty() && !settings.quiet) status::tell("{}\n", engine);
  plugins::require_no_hidden_state(study);
  const study_run::InterruptionWatch interruption;
  const storage::OutputLock lock(settings.output);
  storage::require_replaceable(settings.output);
  commands::print_fallback_lock(lock, settings.output);
  bool printed = false;
  settings.proven = [&](const tuning::TuneAnswer& proven) {
    if (!json) standard_output::write_fitted(tuning::proven_text(proven, study, settings.output.string()));
    printed = true;
  };
  const tuning::TuneAnswer answer = tuning::tune(study, settings, interruption.token());
  if (page)
    command_line::write_text(*page, report::html_page(tuning::tuning_page(answer, study, settings.output)));
  if (json) {
    standard_output::write(tuning::json_of(answer, study));
  } else {
    if (!printed) standard_output::write_fitted(tuning::proven_text(answer, study, settings.output.string()));
    standard_output::write_fitted(tuning::rest_text(answer, study));
  }
  return commands::exit_code_of(answer.status);
}

/// A study, and the point of it that is asked for.
struct PointToExamine {
  study::Study study;
  std::int64_t point{0};
};

PointToExamine point_to_examine(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  PointToExamine examined;
  if (commands::is_results_file(path)) {
    if (arguments.has("set"))
      arguments.refuse("option '--set': changes a manifest, not a results file; expected a manifest");
    const reading::ResultsFile file(path);
    if (file.header().plugin)
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: its controller is a plugin, which the file does not contain; expected its "
                      "manifest",
                      path));
    examined.study = layout::recorded_study(file.header(), path);
  } else {
    examined.study = commands::load_study(path, arguments);
  }
  const study::Study& study = examined.study;
  goal::require_targets(study, path);
  const std::optional<std::int64_t> point = command_line::point_option(arguments, study.point_labels);
  if (!point && study::point_count(study) > 1)
    throw Failure(ExitCode::bad_input, fmt::format("{}: it has {} design points; expected one with --point",
                                                   path, study::point_count(study)));
  examined.point = point.value_or(0);
  return examined;
}

/// @throws Failure (interrupted) where `work` throws Interrupted
template <class Work>
auto unless_interrupted(const Work& work) {
  try {
    return work();
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was written");
  }
}

ExitCode limits(const command_line::Arguments& arguments) {
  const PointToExamine examined = point_to_examine(arguments);
  const study::Study& study = examined.study;
  const study_run::InterruptionWatch interruption;
  const std::vector<tuning::Limit> limits = unless_interrupted([&] {
    return tuning::limits_of(study, tuning::units_of(study, examined.point), interruption.token());
  });
  if (arguments.choice("format") == "json") {
    standard_output::write(tuning::limits_json(limits));
  } else {
    standard_output::write_fitted(tuning::limits_text(limits, goal::question_of(study)));
  }
  return ExitCode::success;
}

/// The folder from which the operand names its files; nothing for a results file.
std::optional<std::filesystem::path> folder_of(const std::filesystem::path& operand) {
  if (commands::is_results_file(operand)) return std::nullopt;
  return std::filesystem::absolute(yaml::is_stream(operand) ? "." : operand).parent_path();
}

ExitCode worst(const command_line::Arguments& arguments) {
  const std::optional<std::filesystem::path> output = command_line::text_place(arguments, "output");
  if (output) command_line::require_places(arguments, {arguments.operands()[0]}, {*output});
  const PointToExamine examined = point_to_examine(arguments);
  const study::Study& study = examined.study;
  const study_run::InterruptionWatch interruption;
  const tuning::WorstMachines worst = unless_interrupted([&] {
    return tuning::worst_machines(study, tuning::units_of(study, examined.point),
                                  folder_of(arguments.operands()[0]), interruption.token());
  });
  if (arguments.choice("format") == "json") {
    standard_output::write(tuning::worst_json(worst));
  } else {
    standard_output::write_fitted(tuning::worst_text(worst, study));
  }
  if (!output) return ExitCode::success;
  if (worst.in_box.manifest.empty())
    throw Failure(ExitCode::bad_input, fmt::format("{}: no manifest describes the worst machine: {}",
                                                   output->string(), worst.in_box.no_manifest));
  command_line::write_text(*output, worst.in_box.manifest);
  if (arguments.choice("format") == "text" && !yaml::is_standard_stream(*output))
    standard_output::write(fmt::format(
        "wrote {0}{1}; the machine's worst trial: zerocount trace {0} --trial {2}\n", output->string(),
        worst.with_profiles ? fmt::format(", of which rig {} is the machine", worst.in_box.rig)
                            : std::string(),
        worst.in_box.trial));
  return ExitCode::success;
}

command_line::OptionSpec set_option() {
  return {"set", "KEY=VALUE", "override a manifest key, e.g. controller.delay=1; may be repeated", true};
}

}  // namespace

commands::Command tune_command() {
  return {{"tune",
           "MANIFEST -o FILE",
           {{"output,o", "FILE", "the results file of the proof (required)"},
            command_line::format_option({"text", "json"}),
            {"budget", "B", "of all: a number of trials, or a time such as 60s or 5min"},
            {"report", "PAGE", "write a page (*.html) with maps, what was tried, and the proof"},
            {"threads", "N", "threads to use; default: all cores"},
            set_option(),
            {"quiet,q", "", "print no progress"},
            command_line::force_option()}},
          "find gains that meet the goal, and prove them",
          tune_help,
          tune};
}

commands::Command limits_command() {
  return {{"limits",
           "MANIFEST|FILE",
           {command_line::format_option({"text", "json"}),
            {"point", "P", "the design point, by label or number"},
            set_option()}},
          "what stands between a point and its goal",
          limits_help,
          limits};
}

commands::Command worst_command() {
  return {{"worst",
           "MANIFEST|FILE",
           {command_line::format_option({"text", "json"}),
            {"output,o", "MANIFEST", "write a manifest of the worst machine in the box"},
            {"point", "P", "the design point, by label or number"},
            set_option(),
            command_line::force_option()}},
          "the machine that a gain suits worst",
          worst_help,
          worst};
}

}  // namespace zerocount::design_commands
