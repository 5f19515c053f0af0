#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/report/page.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"
#include "core/text/text.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"
#include "results/storage/output_lock.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/live_page.hpp"
#include "runners/commands/timeline_option.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/study_runner.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::study_commands {
namespace {

namespace fs = std::filesystem;

constexpr const char* run_help =
    "Runs the trials of the manifest on all cores, and writes them to the results file.\n"
    "During the run, finished trials are written to shards in FILE.shards/; at the end these are\n"
    "merged to FILE. To continue a run that was interrupted or killed, give the same command\n"
    "again. The data do not depend on the number of threads, on --shard, or on interruptions.\n"
    "If FILE has the same study with fewer trials, only the missing trials are run and added.\n"
    "The run first checks that the disk has room for the shards and the file; --force skips\n"
    "this check.\n"
    "--watch writes a page for a browser every 2 s: progress, time left, and what the trials so far\n"
    "show of the goal, under every condition. It loads itself again without a network. At the end it\n"
    "is the page of 'zerocount report FILE'; after Ctrl-C or an error it says so.\n"
    "\n"
    "Examples:\n"
    "  zerocount run experiments/manifests/paper-gains.yaml -o gains.h5\n"
    "  zerocount run study.yaml --set trials=100000 --set controller.ki=9.45e-5 -o out.h5\n"
    "  zerocount run study.yaml --shard 1/2 -o a.h5     on one machine, and on another\n"
    "  zerocount run study.yaml --shard 2/2 -o b.h5     then: zerocount merge a.h5 b.h5 -o all.h5\n";

/// Rows (numbers of the trials) that belong to one part of the study. Parts differ by at most one trial in
/// size.
/// @param text value of the option --shard, "I/N": part I of N, I from 1 to N
layout::RowRange part_of(const command_line::Arguments& arguments, const std::string& text,
                         const study::Study& study) {
  const std::size_t slash = text.find('/');
  const auto part = text::parse_number<std::int64_t>(text.substr(0, slash));
  const auto parts =
      slash == std::string::npos ? std::nullopt : text::parse_number<std::int64_t>(text.substr(slash + 1));
  if (!part || !parts || *part < 1 || *part > *parts) {
    arguments.refuse(fmt::format("option '--shard': '{}' is not I/N with 1 ≤ I ≤ N, such as 2/8", text));
  }
  const std::int64_t rows = study::trial_count(study);
  if (*parts > rows) {
    arguments.refuse(fmt::format(
        "option '--shard': the {} trials of the study cannot be divided into {} parts", rows, *parts));
  }
  const auto start = [&](std::int64_t i) { return rows / *parts * i + std::min(i, rows % *parts); };
  return {start(*part - 1), start(*part) - start(*part - 1)};
}

/// Request of the command `run`: the study to run, its output, and what else to write.
struct RunRequest : study_run::FileRun {
  bool force{false};
  std::optional<fs::path> page;          ///< Page of the option --watch; nothing: no page.
  std::optional<fs::path> trace_events;  ///< File of the option --timeline; nothing: no timeline.
};

/// Checks that the study is the one whose hash the option --study gives. Does nothing without the option.
/// @throws Failure (bad_input) if it is another study.
void require_study_of_option(const command_line::Arguments& arguments, const study::Study& study) {
  const std::optional<std::string> wanted = arguments.value("study");
  if (!wanted || *wanted == study.study_sha256) return;
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: not the study asked for: with its overrides, samples and plugin its SHA-256 is {}; "
                  "expected {}",
                  arguments.operands()[0], study.study_sha256, *wanted));
}

RunRequest run_request(const command_line::Arguments& arguments) {
  RunRequest request;
  request.output = command_line::output_place(arguments);
  request.page = commands::watched_page(arguments);
  request.trace_events = commands::timeline_place(arguments);
  request.study = commands::load_study(arguments.operands()[0], arguments);
  require_study_of_option(arguments, request.study);
  request.study.engine =
      arguments.choice("engine") == "batch" ? study::Engine::batch : study::Engine::reference;
  const std::optional<std::string> part = arguments.value("shard");
  request.wanted = part ? part_of(arguments, *part, request.study) : layout::all_rows(request.study);
  if (request.study.stop && part) {
    arguments.refuse(
        "option '--shard': a study with `stop` cannot be divided, because its number of trials is decided "
        "while it runs");
  }
  request.threads = static_cast<int>(arguments.whole_number("threads", 1, 4096).value_or(0));
  request.quiet = arguments.has("quiet");
  request.force = arguments.has("force");
  request.check_room = !request.force;
  if (request.force) request.foreign = study_run::ForeignShards::remove;
  return request;
}

/// Sections of a page with the summary of the trials that an unfinished run has finished so far.
std::vector<report::PageSection> sections_so_far(const fs::path& output) {
  const summary::StudySummary summary =
      summary::summarise_unfinished(output, statistics::summary_confidence, false);
  return {report::answer_section("so-far", "The answer so far", summary_answer::summary_answer(summary))};
}

/// Page of a finished results file: its report or, if it does not keep every trial, its summary.
report::ReportPage page_of(const fs::path& output) {
  if (shards::keeps_every_trial(output))
    return commands::verified_report(reading::AllTrialsFile(output)).page;
  const summary::StudySummary summary = summary::summarise_file(output);
  return report::answer_page(summary_answer::summary_answer(summary));
}

void run_to_output(const RunRequest& request, const std::stop_token& stop) {
  const study_run::ExistingUse existing =
      request.force ? study_run::ExistingUse::none
                    : study_run::use_of_existing(request.output, request.study, request.wanted);
  if (existing == study_run::ExistingUse::complete) {
    // Shards left by a run that was killed at its very end. Shards of other studies are kept.
    const fs::path directory = layout::shards_directory(request.output);
    study_run::remove_shards(
        directory,
        study_run::choose_shards(shards::list_shards(directory, request.study).shards, request.wanted).all);
    if (!request.quiet) status::tell("{}: already complete, nothing to run\n", request.output.string());
    return;
  }
  storage::require_replaceable(request.output);
  if (request.study.stop) {
    study_run::run_sequential(request, stop);
  } else {
    study_run::run_to_file(request, existing, stop);
  }
}

ExitCode run(const command_line::Arguments& arguments) {
  RunRequest request = run_request(arguments);
  const parallel::ThreadLimit limit(trials::threads_to_use(request.threads));
  commands::print_warnings(request.study);
  if (request.study.plugin && !request.quiet) {
    status::tell("the controller is the plugin {} {}\n", request.study.plugin->description.name,
                 request.study.plugin->description.version);
  }
  const std::string engine = forecast::engine_text(forecast::points_on_reference(request.study));
  if (!engine.empty() && !request.quiet) status::tell("{}\n", engine);
  request.study.engine = trials::engine_that_runs(request.study);
  plugins::require_no_hidden_state(request.study);
  const status::InterruptionWatch interruption;
  const storage::OutputLock lock(request.output);
  commands::print_fallback_lock(lock, request.output);
  commands::LivePage live(request.page,
                          {.title = request.study.name,
                           .subtitle = request.study.description,
                           .footer = "",
                           .sections = {},
                           .kind = "run"},
                          [&] { return sections_so_far(request.output); });
  return live.during([&] {
    request.listener = live.listener();
    commands::with_timeline(request.trace_events, [&](timeline::Timeline* timeline) {
      request.timeline = timeline;
      run_to_output(request, interruption.token());
    });
    if (request.page) live.finish(report::html_page(page_of(request.output)));
    return ExitCode::success;
  });
}

}  // namespace

commands::Command run_command() {
  return {
      {"run",
       "MANIFEST|FILE -o FILE",
       {command_line::renewed_file({"output,o", "FILE", "the results file to make (required)"}),
        command_line::excluding({"shard"}, commands::watch_option()),
        {"threads", "N", "threads to use; default: all cores"},
        command_line::choice_option("engine", "NAME", {"batch", "reference"},
                                    "many trials at a time in SIMD lanes, or one at a time"),
        {"shard", "I/N", "run only the I-th of N parts, into a part file for 'zerocount merge'"},
        {"study", "SHA256", "refuse a study with another hash, such as one whose manifest has changed"},
        {"set", "KEY=VALUE",
         "override a manifest key, e.g. controller.ki=2e-5; may be repeated; recorded in the file", true},
        commands::timeline_option(),
        {"quiet,q", "", "print no progress"},
        {"force", "",
         "replace all files named, remove unfinished runs of other studies, skip the check of disk space"}}},
      "run a study: manifest in, results file out",
      run_help,
      run};
}

}  // namespace zerocount::study_commands
