#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/live_page.hpp"
#include "runners/commands/timeline_option.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/trials/study_runner.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/tuner.hpp"

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
    "that cannot win is dropped early. Of several goals all must be met, under every condition: the\n"
    "worst decides. The bounds are of the proof alone. FILE is its results file, whose manifest has\n"
    "the tuned values.\n"
    "\n"
    "The proven answer is printed at once, when FILE is complete: what the values do, and their margins.\n"
    "Then the extras follow, each as it is ready, by simulation alone; `tune FILE --extras …` makes them\n"
    "for a FILE that is there.\n"
    "\n"
    "--budget bounds all together: the search, which takes half, the proof, and the extras. It is a\n"
    "number of trials, with which the answer depends on the seed alone, or a time such as 60s or\n"
    "5min. Extras that it is not enough for are named. Without it the search takes 500000 trials at\n"
    "most, and tune measures at its start how long that is on this machine.\n"
    "Ctrl-C keeps the simulated points, and after the proof what is printed; the same command goes on.\n"
    "The exit code is 0 if the goal is met, 1 if no values in the ranges meet it, 3 if the proof\n"
    "does not decide it, 130 after Ctrl-C.\n"
    "\n"
    "Example: zerocount tune my-axis.yaml -o tuned.h5 -m tuned.yaml\n";

/// Path of the option `--manifest`, the file for the tuned manifest, after a check that it can be written;
/// nothing without the option.
std::optional<std::filesystem::path> manifest_option(const command_line::Arguments& arguments,
                                                     const study::Study& study) {
  std::optional<std::filesystem::path> place = command_line::text_place(arguments, "manifest");
  if (!place) return place;
  const std::filesystem::path operand = arguments.operands()[0];
  const bool is_beside = !commands::is_results_file(operand) && !yaml::is_stream(operand) &&
                         operand.parent_path() == place->parent_path();
  if ((study.plugin || study.samples) && !is_beside)
    arguments.refuse(
        "option '--manifest': the manifest names files from its own folder; expected a place in this folder");
  return place;
}

/// Text of the study's manifest with the tuned values. Comments are kept; if a value cannot be written into
/// the text, the manifest's content without comments.
std::string tuned_manifest(const study::Study& study, const tuning::TuneAnswer& answer) {
  const study::Study tuned =
      tuning::with_values_in_text(study, tuning::overrides_of(answer.free, answer.tuned.values));
  if (tuned.manifest.overrides.empty()) return tuned.manifest.text;
  return manifest_text::manifest_of_point(tuned, 0, {.folder = "."});
}

/// Names of all extras for the help, such as "margins,ages,room,…".
std::string names_of_extras() {
  std::vector<std::string_view> names;
  for (const tuning::Extra& extra : all_extras()) names.push_back(extra.name);
  return fmt::format("{}", fmt::join(names, ","));
}

command_line::OptionSpec extras_spec() {
  std::vector<std::string> words{"none", "all"};
  for (const tuning::Extra& extra : all_extras()) words.emplace_back(extra.name);
  return command_line::list_of(std::move(words),
                               {"extras", "E", "none, all (default), or some of " + names_of_extras()});
}

/// Extras that the option `--extras` asks for; refuses those that the study cannot have.
/// @param with_page whether a page is made, which has maps
std::vector<const tuning::Extra*> extras_option(const command_line::Arguments& arguments,
                                                const study::Study& study, bool with_page) {
  std::vector<const tuning::Extra*> wanted;
  const std::string text = arguments.value("extras").value_or("all");
  if (text == "none") return wanted;
  std::vector<std::string> names;
  std::istringstream words(text);
  for (std::string name; text != "all" && std::getline(words, name, ',');) names.push_back(name);
  if (text != "all" && names.empty()) arguments.refuse("option '--extras': expected none, all, or names");
  for (const std::string& name : names) {
    if (std::ranges::find(all_extras(), name, &tuning::Extra::name) == all_extras().end())
      arguments.refuse(
          fmt::format("option '--extras': '{}' is not an extra; expected none, all, or some of {}", name,
                      names_of_extras()));
  }
  for (const tuning::Extra& extra : all_extras()) {
    const bool is_named = std::ranges::find(names, extra.name) != names.end();
    const std::string refusal = extra.refusal == nullptr ? "" : extra.refusal(study, with_page);
    if (is_named && !refusal.empty()) arguments.refuse("option '--extras': " + refusal);
    if (is_named || (text == "all" && refusal.empty())) wanted.push_back(&extra);
  }
  return wanted;
}

tuning::TuneSettings tune_settings(const command_line::Arguments& arguments) {
  tuning::TuneSettings settings;
  settings.threads = static_cast<int>(arguments.whole_number("threads", 1, 4096).value_or(0));
  settings.quiet = arguments.has("quiet");
  const command_line::Budget budget = command_line::budget_option(arguments);
  settings.budget = {budget.trials, budget.seconds};
  settings.force = arguments.has("force");
  return settings;
}

/// Prints the answer of `tune`. As text, it prints the proven answer as soon as the proof is complete, then
/// each extra when it is ready. In other formats it prints the whole answer at the end.
class TunePrinter {
 public:
  explicit TunePrinter(const command_line::Arguments& arguments)
      : arguments_(arguments), in_parts_(arguments.choice("format") == "text") {}

  void print_proven(const Tuning& tuning) {
    if (!in_parts_ || printed_) return;
    answers::print(arguments_, proven_answer(), tuning);
    standard_output::flush();
    printed_ = true;
  }

  void print_extra(const tuning::Extra& extra, const Tuning& tuning) {
    if (!in_parts_) return;
    const document::Answer answer =
        extra_answer(extra).of(tuning, ExitCode::success, document::Audience::people);
    if (document::text(answer).empty()) return;
    standard_output::write("\n");
    answers::print(arguments_, answer);
    standard_output::flush();
  }

  ExitCode print_rest(const Tuning& tuning) {
    print_proven(tuning);
    const ExitCode code =
        tuning.answer.interrupted ? ExitCode::interrupted : commands::exit_code_of(tuning.answer.status);
    if (in_parts_) standard_output::write("\n");
    return answers::print(arguments_, in_parts_ ? closing_answer() : tune_answer(), tuning, code);
  }

 private:
  const command_line::Arguments& arguments_;
  bool in_parts_;
  bool printed_{false};
};

/// Task of a call of the command `tune`: to tune the study of a manifest, or to describe the results file of
/// an earlier proof.
struct TuneTask {
  const study::Study& study;
  tuning::TuneSettings settings;
  std::optional<std::filesystem::path> page{};  ///< Path of the HTML page for the answer; nothing: none.
  /// Path of the HTML page that also shows intermediate results; nothing: none.
  std::optional<std::filesystem::path> watched{};
  /// Path for a manifest with the tuned values; nothing: none is written.
  std::optional<std::filesystem::path> manifest{};
  /// Path of the file for the timeline of the threads; nothing: none.
  std::optional<std::filesystem::path> timeline{};
  bool is_of_file{false};
};

/// Text of the effort that a search has spent: "14688 of 60000 trials", "21 of 60 s", "14688 trials".
/// @param seconds time since the start of the tuning, s
std::string spent_of(const tuning::TuneBudget& budget, const tuning::SearchProgress& progress,
                     double seconds) {
  if (budget.seconds) return fmt::format("{:.3g} of {:g} s", seconds, *budget.seconds);
  return budget.trials ? fmt::format("{} of {} trials", progress.trials, *budget.trials)
                       : fmt::format("{} trials", progress.trials);
}

ExitCode run_task(const command_line::Arguments& arguments, TuneTask task) {
  const bool in_html = arguments.choice("format") == "html";
  task.settings.page = task.page || task.watched || in_html;
  task.settings.extras = extras_option(arguments, task.study, task.settings.page);
  if (task.settings.page) report::require_drawing_libraries();
  const parallel::ThreadLimit limit(trials::threads_to_use(task.settings.threads));
  commands::print_warnings(task.study);
  const std::string engine = forecast::engine_text(forecast::points_on_reference(task.study));
  if (!engine.empty() && !task.settings.quiet) status::tell("{}\n", engine);
  plugins::require_no_hidden_state(task.study);
  const status::InterruptionWatch interruption;
  commands::LivePage live(task.watched, frame_of(task.study), {});
  task.settings.listener = live.listener();
  TunePrinter printer(arguments);
  const auto tuning_of = [&](const tuning::TuneAnswer& answer, bool drawn = false) {
    return Tuning{answer, task.study, task.settings.output, drawn, task.is_of_file};
  };
  const auto start = std::chrono::steady_clock::now();
  task.settings.searching = [&](const tuning::SearchProgress& progress) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    live.show(
        {search_section({task.study, progress, spent_of(task.settings.budget, progress, elapsed.count())})});
  };
  task.settings.found = [&](const tuning::TuneAnswer& found) {
    const std::string line = sanity_line(tuning_of(found));
    if (!line.empty() && !task.settings.quiet) status::tell("{}\n", line);
  };
  task.settings.proven = [&](const tuning::TuneAnswer& proven) {
    if (task.manifest) command_line::write_text(*task.manifest, tuned_manifest(task.study, proven));
    printer.print_proven(tuning_of(proven));
    if (task.watched) live.show(tuning_sections(tuning_of(proven)));
  };
  task.settings.ready = [&](const tuning::Extra& extra, const tuning::TuneAnswer& answer) {
    printer.print_extra(extra, tuning_of(answer));
    if (task.watched) live.show(tuning_sections(tuning_of(answer)));
  };
  const auto tune = [&] {
    const tuning::TuneAnswer found = (task.is_of_file ? tuning::describe_tuned : tuning::tune)(
        task.study, task.settings, interruption.token());
    if (task.manifest && found.tuned.values.empty())
      status::tell("no values to write into {}\n", task.manifest->string());
    if (task.page || task.watched) {
      const std::string page = report::html_page(tuning_page(tuning_of(found)));
      if (task.page) command_line::write_text(*task.page, page);
      live.finish(page);
    }
    return printer.print_rest(tuning_of(found, in_html));
  };
  return live.during([&] { return commands::recorded(task.timeline, "tune", tune); });
}

/// Refuses options that need a manifest, for a call with the results file of a proof. For such a file nothing
/// is tuned, and nothing is written but a page.
void refuse_options_of_manifests(const command_line::Arguments& arguments) {
  const bool replaces_page = arguments.has("report") || arguments.has("watch");
  for (const char* const option : {"output", "manifest", "force"}) {
    if (arguments.has(option) && !(replaces_page && std::string_view(option) == "force"))
      arguments.refuse(fmt::format("option '--{}': applies to a manifest, not to a results file", option));
  }
}

ExitCode tune(const command_line::Arguments& arguments) {
  const std::string& operand = arguments.operands()[0];
  const bool is_of_file = commands::is_results_file(operand);
  if (is_of_file) refuse_options_of_manifests(arguments);
  tuning::TuneSettings settings = tune_settings(arguments);
  settings.output = is_of_file ? std::filesystem::path(operand) : command_line::output_place(arguments);
  const study::Study study = commands::load_study(operand, arguments);
  TuneTask task{.study = study,
                .settings = std::move(settings),
                .page = commands::page_option(arguments, "report"),
                .watched = commands::watched_page(arguments),
                .timeline = commands::timeline_place(arguments),
                .is_of_file = is_of_file};
  if (is_of_file) return run_task(arguments, std::move(task));
  task.manifest = manifest_option(arguments, study);
  const std::filesystem::path output = task.settings.output;
  const storage::OutputLock lock(output);
  storage::require_replaceable(output);
  commands::print_fallback_lock(lock, output);
  return run_task(arguments, std::move(task));
}

}  // namespace

commands::Command tune_command() {
  return {
      {"tune",
       "MANIFEST -o FILE | FILE",
       {command_line::renewed_file(
            {"output,o", "FILE", "the results file of the proof (required with a manifest)"}),
        answers::format_option(),
        {"budget", "B",
         "budget of search, proof and extras together: a number of trials, or a time such as 60s or 5min"},
        command_line::written_file({"manifest,m", "TUNED", "write the manifest with the tuned values"}),
        extras_spec(),
        command_line::page_file(
            {"report", "PAGE", "write a page (*.html) with maps, what was tried, and the proof"}),
        commands::watch_option(),
        commands::timeline_option(),
        {"threads", "N", "threads to use; default: all cores"},
        set_option(),
        {"quiet,q", "", "print no progress"},
        command_line::force_option()}},
      "find gains that meet the goal, and prove them",
      tune_help,
      tune,
      [] { return std::vector{tune_answer().complete_type()}; }};
}

}  // namespace zerocount::design_commands
