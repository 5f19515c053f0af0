#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/text/text.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/commands/command.hpp"
#include "runners/status/progress.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/verification/verification.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* verify_help =
    "Checks the integrity of results files. FILE is a results file, a part of a study or a\n"
    "shard; of a folder, all its files *.h5 and *.shard. One line per check, ok or FAILED:\n"
    "checksum: no byte has changed since the file was written;\n"
    "statistics: the attributes are those of the manifest; inputs, measures and jerks are in their\n"
    "ranges; and the file, made again from its manifest and its trials, has the same datasets, units\n"
    "and values: row numbers, design points, profiles, machines and statistics. This needs room for a\n"
    "copy of the file in the folder for temporary files;\n"
    "trials run again: a random sample of the trials gives the recorded inputs, measures, jerks and\n"
    "sample records, bitwise if this program on this kind of processor wrote the file; for a file\n"
    "that keeps failures, also as many of these;\n"
    "shards: the shards of a folder belong to one study, and none of them share a trial;\n"
    "all trials: how many trials no shard of the folder has (not a failure).\n"
    "A file that another program opened to write, such as h5py with mode 'a', has lost its checksum.\n"
    "The exit code is 4 if a check fails, and 5 if a file cannot be read.\n"
    "\n"
    "Examples:\n"
    "  zerocount verify gains.h5 --trials 1000\n"
    "  zerocount verify gains.h5.shards --format json\n";

constexpr std::int64_t default_trials = 20;
constexpr std::int64_t max_trials = std::int64_t{1} << 53;
constexpr std::int64_t default_seed = 1;

using Reports = std::vector<verification::CheckReport>;

std::string line_of(const verification::CheckReport& report, const verification::Check& check) {
  const std::string subject = fmt::format("{}: {}", text::printable(report.path.string()), check.name);
  if (check.skipped) return fmt::format("skipped {}: {}\n", subject, check.detail);
  if (check.problems.empty())
    return fmt::format("ok      {}{}{}\n", subject, check.detail.empty() ? "" : ": ",
                       text::printable(check.detail));
  std::string lines;
  for (const std::string& problem : check.problems)
    lines += fmt::format("FAILED  {}: {}\n", subject, text::printable(problem));
  return lines;
}

std::string lines_of(const Reports& reports) {
  std::string lines;
  for (const verification::CheckReport& report : reports) {
    for (const verification::Check& check : report.checks) lines += line_of(report, check);
  }
  return lines;
}

ExitCode code_of(const Reports& reports) {
  if (std::any_of(reports.begin(), reports.end(), [](const auto& report) { return report.unreadable; }))
    return ExitCode::machine_failed;
  const bool all = std::all_of(reports.begin(), reports.end(), verification::holds);
  return all ? ExitCode::success : ExitCode::bad_data;
}

/// First line of the answer of `verify`, such as "2 of 3 files hold all their checks".
std::string headline_of(const Reports& reports) {
  const auto holding = std::ranges::count_if(reports, verification::holds);
  if (reports.size() == 1) return holding == 1 ? "all checks hold" : "not all checks hold";
  return fmt::format("all checks hold in {} of {} files and folders", holding, reports.size());
}

document::Description<verification::Check> check_description() {
  using document::in_data;
  return document::Description<verification::Check>()
      .value(in_data("check", "name of the check"), &verification::Check::name)
      .value(in_data("ok", "whether it has found no problem"),
             [](const verification::Check& c) { return c.problems.empty(); })
      .value(in_data("skipped", "whether it was left out"), &verification::Check::skipped)
      .value(in_data("detail", "what was checked, or why it was left out"), &verification::Check::detail)
      .value(in_data("problems", "what does not hold"), &verification::Check::problems);
}

document::AnswerDescription<Reports> verify_answer() {
  using document::in_data;
  document::AnswerDescription<Reports> answer{
      {.name = "verify",
       .meaning = "whether results files hold what their manifests say",
       .csv_table = "files.checks"},
      {}};
  answer.items.headline(headline_of)
      .value(in_data("ok", "whether all checks hold"),
             [](const Reports& reports) { return code_of(reports) == ExitCode::success; })
      .table(in_data("files", "the files, and the folders of shards"),
             document::Description<verification::CheckReport>()
                 .value(in_data("path", "the file or folder"),
                        [](const auto& report) { return report.path.string(); })
                 .value(in_data("ok", "whether all its checks hold"), verification::holds)
                 .table(in_data("checks", "its checks"), check_description(),
                        &verification::CheckReport::checks),
             std::identity())
      .sentence(lines_of);
  return answer;
}

ExitCode verify(const command_line::Arguments& arguments) {
  verification::VerifySettings settings;
  settings.trials = arguments.whole_number("trials", 0, max_trials).value_or(default_trials);
  settings.seed = static_cast<std::uint64_t>(
      arguments.whole_number("seed", 0, std::int64_t{1} << 53).value_or(default_seed));
  if (settings.trials == 0 && arguments.has("seed"))
    arguments.refuse("option '--seed' needs trials to run again, but '--trials' is 0");
  settings.plugin = commands::plugin_option(arguments);
  const status::InterruptionWatch interruption(status::InterruptionWatch::Unstopped::end,
                                               [scratch = settings.scratch] { scratch->close(); });
  settings.stop = interruption.token();
  const std::vector<std::filesystem::path> operands(arguments.operands().begin(), arguments.operands().end());
  const Reports reports = verification::verify(operands, settings);
  return answers::print(arguments, verify_answer().of(reports, code_of(reports)));
}

}  // namespace

commands::Command verify_command() {
  return {{"verify",
           "FILE|FOLDER...",
           {{"trials", "N", "trials to run again, per file or per folder of shards (default 20)"},
            {"seed", "S", "seed of the choice of these trials (default 1)"},
            command_line::read_file({"plugin", "LIBRARY", "the controller plugin of the study"}),
            answers::format_option()},
           1,
           100000},
          "check results files, and run a sample of their trials again",
          verify_help,
          verify,
          [] { return std::vector{verify_answer().complete_type()}; }};
}

}  // namespace zerocount::study_commands
