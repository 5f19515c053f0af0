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
#include "runners/commands/commands.hpp"
#include "runners/run_status/run_status.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::commands {
namespace {

constexpr const char* status_help =
    "Prints how far a run has come, and the summary of the trials that are finished: of a run on this\n"
    "machine, which writes FILE.shards/, or of an array job (zerocount slurm), which writes FILE.parts/.\n"
    "It reads these files alone, so it can be asked for on any machine that sees them. A part is running\n"
    "if a process has it locked; where the locks of other machines cannot be seen, if a shard of it was\n"
    "written in the last minute. The rate is that since the jobs were submitted, or the run has begun.\n"
    "Of a study with `stop` the number of trials is the largest that there may be. JSON has no summary (see\n"
    "zerocount summary), and with --watch one line each time.\n"
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

/// The summary of the finished trials; why there is none, if a file is damaged or no trial of a rig is
/// finished before those that are missing.
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
  standard_output::print("{}", run_status::status_text(status));
  if (status.complete) standard_output::print("see 'zerocount summary {}'\n", output.string());
  if (!status.complete && status.finished > 0) standard_output::print("\n{}", summary_so_far(output));
  return status;
}

ExitCode print_statuses(const command_line::Arguments& arguments) {
  const std::filesystem::path output = arguments.operands()[0];
  const std::optional<std::int64_t> seconds = arguments.whole_number("watch", 1, 86400);
  const bool json = arguments.choice("format") == "json";
  constexpr int indented = 2;
  const auto indent = json ? std::optional(seconds ? text::one_line : indented) : std::nullopt;
  run_status::RunStatus status = print_status(output, indent);
  while (seconds && !status.complete) {
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::seconds(*seconds));
    if (isatty(STDOUT_FILENO) == 1) std::fputs(clear_screen, stdout);
    status = print_status(output, indent);
  }
  return status.finished == 0 && !status.problems.empty() ? ExitCode::bad_data : ExitCode::success;
}

}  // namespace

Command status_command() {
  return {{"status",
           "FILE",
           {{"watch", "S", "print it again every S seconds until FILE is complete, or you stop it"},
            command_line::format_option({"table", "json"})}},
          "how far a run or an array job has come, with the summary so far",
          status_help,
          print_statuses};
}

}  // namespace zerocount::commands
