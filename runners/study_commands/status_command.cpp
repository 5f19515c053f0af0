#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/report_json.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"
#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "results/shards/pieces.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/commands/command.hpp"
#include "runners/run_status/run_status.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/progress.hpp"
#include "runners/study_commands/study_commands.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* status_help =
    "Prints the progress of a run, and the summary of its finished trials: of a run on this machine,\n"
    "which writes FILE.shards/, or of an array job, whose parts are FILE.parts/part-1-of-8.h5 and so on.\n"
    "It reads only these files, so it works on any machine that sees them. A part is running if a\n"
    "process has locked it; if the locks of another machine cannot be seen, if one of its shards was\n"
    "written in the last minute. The rate is the sum of those of the processes, each since it began.\n"
    "For a study with `stop` the number of trials is the maximum. JSON has no summary (see\n"
    "zerocount summary), and is one line each time with --watch.\n"
    "--watch ends when FILE is complete, or with exit code 4 when no process runs the study any more.\n"
    "\n"
    "Examples:\n"
    "  zerocount status study.h5\n"
    "  zerocount status study.h5 --watch 30\n";

constexpr const char* clear_screen = "\x1b[H\x1b[J";

/// State of a run or an array job, with the summary of its finished trials.
struct StatusResults {
  const run_status::RunStatus& status;
  const std::filesystem::path& output;
  /// Summary of the trials that are finished so far; null without one.
  const summary_answer::SummaryResults* summary{nullptr};
  std::string no_summary{};  ///< Reason why there is no summary; empty if there is one, or if none was tried.
};
using Status = const StatusResults&;

/// First line of the answer of `status`, such as "study: running, 12000 of 50000 trials (24.0 %), 812.4
/// trials/s, 46 s to go".
std::string headline(Status s) {
  const run_status::RunStatus& status = s.status;
  std::string text = status.name.empty() ? "no trial is finished yet" : status.name;
  text += status.complete ? ": complete" : status.running ? ": running" : ": not running";
  if (status.trials > 0) {
    text += fmt::format(", {} of {} trials ({:.1f} %)", status.finished, status.trials,
                        100.0 * static_cast<double>(status.finished) / static_cast<double>(status.trials));
  }
  if (status.running && status.rate > 0.0) {
    text +=
        fmt::format(", {:.4g} trials/s, {} to go", status.rate, status::duration_text(status.remaining()));
  }
  return text;
}

std::string next_step(Status s) {
  if (s.status.complete) return fmt::format("see: zerocount summary {}", text::shell_path(s.output));
  const std::optional<run_status::PartCounts>& parts = s.status.parts;
  if (parts && parts->complete == parts->all)
    return fmt::format("not merged: zerocount merge {} -o {}",
                       text::shell_path(shards::parts_directory(s.output)), text::shell_path(s.output));
  return {};
}

std::string problem_lines(Status s) {
  std::string lines;
  for (const std::string& problem : s.status.problems) lines += fmt::format("problem: {}\n", problem);
  return lines;
}

document::Description<run_status::PartCounts> parts_description() {
  using document::everywhere;
  using Parts = run_status::PartCounts;
  return document::Description<Parts>()
      .value(everywhere("all", "all", "parts of the array job"), &Parts::all)
      .value(everywhere("complete", "complete", "parts with all their trials"), &Parts::complete)
      .value(everywhere("running", "running", "parts that a process runs"), &Parts::running)
      .value(everywhere("interrupted", "interrupted", "parts with finished trials that no process runs"),
             &Parts::interrupted)
      .value(everywhere("waiting", "waiting", "parts that have not begun"), &Parts::waiting);
}

document::Description<run_status::RunStatus> run_description() {
  using document::in_data;
  using Run = run_status::RunStatus;
  return document::Description<Run>()
      .value(in_data("complete", "whether the results file is complete"), &Run::complete)
      .value(in_data("name", "name of the study; empty if no file could be read"), &Run::name)
      .value(in_data("running", "whether a process runs it"), &Run::running)
      .value(in_data("trials", "trials of the study; the maximum with 'stop'"), &Run::trials)
      .value(in_data("finished", "trials in complete files"), &Run::finished)
      .value(in_data("shards", "finished shards, without those of complete parts"), &Run::shards)
      .value(document::to_people("shards"),
             [](const Run& run) { return run.complete ? std::nullopt : std::optional(run.shards); })
      .value(in_data("rate", "sum of the mean rates of the processes that run", "1/s"), &Run::rate)
      .value(in_data("remaining", "time to go at this rate", "s"), &Run::remaining)
      .value(in_data("problems", "files that cannot be read, or were set aside as damaged"), &Run::problems)
      .object({.key = "parts", .heading = "parts", .meaning = "parts of an array job", .optional = true},
              parts_description(), &Run::parts);
}

/// Description of the answer of `status`.
/// @param summary summary of the finished trials, which gives the columns of its table; null: there is none
document::AnswerDescription<StatusResults> status_answer(const summary::StudySummary* summary = nullptr) {
  document::AnswerDescription<StatusResults> answer{
      {.name = "status", .meaning = "progress of a run or an array job"}, {}};
  answer.items.headline(headline)
      .include(run_description(), [](Status s) -> const run_status::RunStatus& { return s.status; })
      .sentence(next_step)
      .sentence(problem_lines)
      .sentence([](Status s) { return s.no_summary; });
  if (summary != nullptr)
    answer.items.object({.heading = "the trials that are finished", .shown = document::Visibility::to_people},
                        summary_answer::summary_description(*summary).items, &StatusResults::summary);
  return answer;
}

/// Summary of the trials of an unfinished run that are finished so far; nothing if it cannot be made.
/// @param reason is then set to the reason: a damaged file, or a machine without a finished trial before the
/// missing ones
std::optional<summary::StudySummary> summary_so_far(const std::filesystem::path& output,
                                                    std::string& reason) {
  try {
    return summary::summarise_unfinished(output, statistics::summary_confidence, false);
  } catch (const Failure& failure) {
    if (failure.code() == ExitCode::machine_failed) throw;
    reason = fmt::format("no summary: {}", failure.what());
  }
  return std::nullopt;
}

document::Answer answer_of(const run_status::RunStatus& status, const std::filesystem::path& output,
                           document::Audience audience) {
  StatusResults reading{status, output};
  std::optional<summary::StudySummary> summary;
  if (!status.complete && status.finished > 0 && audience != document::Audience::json)
    summary = summary_so_far(output, reading.no_summary);
  if (!summary) return status_answer().of(reading, ExitCode::success, audience);
  const summary_answer::SummaryResults of_summary = summary_answer::read_summary(*summary);
  reading.summary = &of_summary;
  return status_answer(&*summary).of(reading, ExitCode::success, audience);
}

/// Prints the state of the run of the first operand, and returns it.
/// @param watched whether it is printed again and again; JSON is then on one line
run_status::RunStatus print_status(const command_line::Arguments& arguments, bool watched) {
  const std::filesystem::path output = arguments.operands()[0];
  const std::string format = arguments.choice("format");
  run_status::RunStatus status = run_status::status_of(output);
  const document::Answer answer = answer_of(status, output, answers::audience_of(format));
  if (watched && format == "json") {
    standard_output::write(document::json_text(answer, text::one_line));
  } else {
    answers::print(arguments, answer);
  }
  return status;
}

[[noreturn]] void refuse_to_watch(const std::filesystem::path& output, const run_status::RunStatus& status) {
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: the run has stopped with {} of {} trials; give its command again to continue",
                  output.string(), status.finished, status.trials));
}

ExitCode print_statuses(const command_line::Arguments& arguments) {
  const std::optional<std::int64_t> seconds = arguments.whole_number("watch", 1, 86400);
  run_status::RunStatus status = print_status(arguments, seconds.has_value());
  while (seconds && !status.complete) {
    if (status.stopped) refuse_to_watch(arguments.operands()[0], status);
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::seconds(*seconds));
    if (isatty(STDOUT_FILENO) == 1) std::fputs(clear_screen, stdout);
    status = print_status(arguments, true);
  }
  return status.finished == 0 && !status.problems.empty() ? ExitCode::bad_data : ExitCode::success;
}

}  // namespace

commands::Command status_command() {
  return {{"status",
           "FILE",
           {{"watch", "S", "print again every S seconds until FILE is complete or its run has stopped"},
            answers::format_option()}},
          "print the progress of a run or an array job, with the summary so far",
          status_help,
          print_statuses,
          [] { return std::vector{status_answer().complete_type()}; }};
}

}  // namespace zerocount::study_commands
