#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/plugin_option.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/study_run/interruption.hpp"
#include "runners/verification/verification.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* verify_help =
    "Checks the integrity of results files. FILE is a results file, a part of a study or a\n"
    "shard; of a folder, all its files *.h5 are checked. One line per check, ok or FAILED:\n"
    "checksum: no byte has changed since the file was written;\n"
    "header: the file was finished, and its attributes and the hash of the study agree with its\n"
    "manifest;\n"
    "datasets: all exist, with the right types, sizes, units and numbers of rows;\n"
    "values: inputs, measures and jerks are in their ranges, and no time is longer than its move;\n"
    "statistics: design points, profiles, rigs and statistics, recomputed from the manifest and\n"
    "the trials, equal those of the file (not for a shard); this needs room for a copy of the file\n"
    "in the folder for temporary files;\n"
    "trials run again: a random sample of the trials gives the recorded inputs, measures, jerks and\n"
    "sample records, bitwise if this program on this kind of processor wrote the file; for a file\n"
    "that keeps failures, also as many of these;\n"
    "shards: the shards of a folder belong to one study, and none of them share a trial;\n"
    "all trials: how many trials no shard of the folder has (not a failure).\n"
    "A file that another program opened to write, such as h5py with mode 'a', has lost its checksum.\n"
    "With --reseal everything else is checked, and all trials are run again unless --trials says\n"
    "how many; if all of it holds, the file gets a new checksum.\n"
    "The exit code is 4 if a check fails, and 5 if a file cannot be read.\n"
    "\n"
    "Examples:\n"
    "  zerocount verify gains.h5 --trials 1000\n"
    "  zerocount verify gains.h5.shards --format json\n";

constexpr std::int64_t default_trials = 20;
constexpr std::int64_t max_trials = std::int64_t{1} << 53;
constexpr std::int64_t default_seed = 1;

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

nlohmann::ordered_json json_of(const verification::CheckReport& report) {
  nlohmann::ordered_json json{{"path", report.path.string()},
                              {"ok", verification::holds(report)},
                              {"checks", nlohmann::ordered_json::array()}};
  for (const verification::Check& check : report.checks) {
    json["checks"].push_back({{"check", check.name},
                              {"ok", check.problems.empty()},
                              {"skipped", check.skipped},
                              {"detail", check.detail},
                              {"problems", check.problems}});
  }
  return json;
}

ExitCode code_of(const std::vector<verification::CheckReport>& reports) {
  if (std::any_of(reports.begin(), reports.end(), [](const auto& report) { return report.unreadable; }))
    return ExitCode::machine_failed;
  const bool all = std::all_of(reports.begin(), reports.end(), verification::holds);
  return all ? ExitCode::success : ExitCode::bad_data;
}

ExitCode verify(const command_line::Arguments& arguments) {
  const std::string format = arguments.choice("format");
  verification::VerifySettings settings;
  settings.reseal = arguments.has("reseal");
  if (settings.reseal && arguments.has("trials"))
    arguments.refuse("option '--reseal' runs all trials again; expected no '--trials' beside it");
  settings.trials =
      arguments.whole_number("trials", 0, max_trials).value_or(settings.reseal ? max_trials : default_trials);
  settings.seed = static_cast<std::uint64_t>(
      arguments.whole_number("seed", 0, std::int64_t{1} << 53).value_or(default_seed));
  if (settings.trials == 0 && arguments.has("seed"))
    arguments.refuse("option '--seed' needs trials to run again, but '--trials' is 0");
  settings.plugin = commands::plugin_option(arguments);
  const study_run::InterruptionWatch interruption;  // so that no temporary folder is left behind
  settings.stop = interruption.token();
  const std::vector<std::filesystem::path> operands(arguments.operands().begin(), arguments.operands().end());
  const std::vector<verification::CheckReport> reports = verification::verify(operands, settings);
  const ExitCode code = code_of(reports);
  if (format == "json") {
    nlohmann::ordered_json json{{"ok", code == ExitCode::success},
                                {"files", nlohmann::ordered_json::array()}};
    for (const verification::CheckReport& report : reports) json["files"].push_back(json_of(report));
    standard_output::write(text::json_text(json));
    return code;
  }
  for (const verification::CheckReport& report : reports) {
    for (const verification::Check& check : report.checks)
      standard_output::print("{}", line_of(report, check));
  }
  return code;
}

}  // namespace

commands::Command verify_command() {
  return {{"verify",
           "FILE|FOLDER...",
           {{"trials", "N",
             "trials to run again, per file or per folder of shards (default 20; all with --reseal)"},
            {"seed", "S", "seed of the choice of these trials (default 1)"},
            {"plugin", "LIBRARY", "the controller plugin of the study"},
            {"reseal", "", "make a checksum again that does not hold, if everything else does"},
            command_line::format_option({"table", "json"})},
           1,
           100000},
          "check results files, and run a sample of their trials again",
          verify_help,
          verify};
}

}  // namespace zerocount::study_commands
