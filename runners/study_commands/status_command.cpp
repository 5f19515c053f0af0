#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "analysis/statistics/unknown.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "runners/commands/command.hpp"
#include "runners/run_status/run_status.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/study_commands/study_commands.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* status_help =
    "Prints the progress of a run, and the summary of its finished trials: of a run on this machine,\n"
    "which writes FILE.shards/, or of an array job (zerocount slurm), which writes FILE.parts/.\n"
    "It reads only these files, so it works on any machine that sees them. A part is running if a\n"
    "process has locked it; if the locks of another machine cannot be seen, if one of its shards was\n"
    "written in the last minute. The rate is the mean since the run began or the jobs were submitted.\n"
    "For a study with `stop` the number of trials is the maximum. JSON has no summary (see\n"
    "zerocount summary), and is one line each time with --watch.\n"
    "--watch ends when FILE is complete, or with exit code 4 when no process runs the study any more.\n"
    "\n"
    "Examples:\n"
    "  zerocount status study.h5\n"
    "  zerocount status study.h5 --watch 30\n";

constexpr const char* clear_screen = "\x1b[H\x1b[J";

nlohmann::ordered_json json_of(const run_status::RunStatus& status) {
  nlohmann::ordered_json json{{"complete", status.complete}, {"name", status.name},
                              {"running", status.running},   {"trials", status.trials},
                              {"finished", status.finished}, {"shards", status.shards},
                              {"rate", status.rate},         {"remaining", status.remaining()},
                              {"problems", status.problems}};
  if (status.parts) {
    json["parts"] = {{"all", status.parts->all},
                     {"complete", status.parts->complete},
                     {"running", status.parts->running},
                     {"interrupted", status.parts->interrupted},
                     {"waiting", status.parts->waiting()}};
  }
  return json;
}

/// The summary of the finished trials, or the reason why it cannot be made: a damaged file, or a rig without
/// a finished trial before the missing ones.
std::string summary_so_far(const std::filesystem::path& output) {
  try {
    return summary::summary_table(
        summary::summarise_unfinished(output, statistics::summary_confidence, false));
  } catch (const Failure& failure) {
    if (failure.code() == ExitCode::machine_failed) throw;
    return fmt::format("no summary: {}\n", failure.what());
  }
}

/// @param json_indent nothing: as a table
run_status::RunStatus print_status(const std::filesystem::path& output, std::optional<int> json_indent) {
  run_status::RunStatus status = run_status::status_of(output);
  if (json_indent) {
    standard_output::write(text::json_text(json_of(status), *json_indent));
    return status;
  }
  standard_output::write_fitted(run_status::status_text(status));
  if (status.complete) standard_output::print("see 'zerocount summary {}'\n", output.string());
  if (!status.complete && status.finished > 0) standard_output::write_fitted("\n" + summary_so_far(output));
  return status;
}

[[noreturn]] void refuse_to_watch(const std::filesystem::path& output, const run_status::RunStatus& status) {
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: the run has stopped with {} of {} trials; give its command again to continue",
                  output.string(), status.finished, status.trials));
}

ExitCode print_statuses(const command_line::Arguments& arguments) {
  const std::filesystem::path output = arguments.operands()[0];
  const std::optional<std::int64_t> seconds = arguments.whole_number("watch", 1, 86400);
  const bool json = arguments.choice("format") == "json";
  constexpr int indented = 2;
  const auto indent = json ? std::optional(seconds ? text::one_line : indented) : std::nullopt;
  run_status::RunStatus status = print_status(output, indent);
  while (seconds && !status.complete) {
    if (status.stopped) refuse_to_watch(output, status);
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::seconds(*seconds));
    if (isatty(STDOUT_FILENO) == 1) std::fputs(clear_screen, stdout);
    status = print_status(output, indent);
  }
  return status.finished == 0 && !status.problems.empty() ? ExitCode::bad_data : ExitCode::success;
}

}  // namespace

commands::Command status_command() {
  return {{"status",
           "FILE",
           {{"watch", "S", "print again every S seconds until FILE is complete or its run has stopped"},
            command_line::format_option({"table", "json"})}},
          "print the progress of a run or an array job, with the summary so far",
          status_help,
          print_statuses};
}

}  // namespace zerocount::study_commands
