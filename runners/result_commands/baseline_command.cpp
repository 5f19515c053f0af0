#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "analysis/pairs/comparison/comparison.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* baseline_help =
    "Makes a results file the baseline of later comparisons, or replaces an earlier baseline.\n"
    "The file is copied unchanged, with its checksum. An entry is appended to OUTPUT.log.yaml:\n"
    "the reason, the build, the trials, the checksums, and a comparison with the replaced\n"
    "baseline. Commit both files together. No --force is needed, because a reason is required.\n"
    "\n"
    "Example: zerocount baseline new.h5 -o results/baselines/paper-gains.h5 --reason \"ki of case a raised\"\n";

ExitCode baseline(const command_line::Arguments& arguments) {
  const std::filesystem::path output = command_line::output_place(arguments);
  const std::string reason = arguments.required("reason");
  if (reason.find_first_not_of(" \t\n") == std::string::npos) {
    arguments.refuse("option '--reason' is empty; say why this becomes the baseline");
  }
  const std::filesystem::path file = arguments.operands()[0];
  const storage::OutputLock lock(output);
  commands::print_fallback_lock(lock, output);
  const comparison::BaselineUpdate update = comparison::update_baseline(file, output, reason);
  if (!update.changed) {
    status::tell("{}: already this file, nothing to do\n", output.string());
    return ExitCode::success;
  }
  for (const std::string& warning : update.warnings)
    status::tell("zerocount baseline: warning: {}\n", warning);
  if (!update.comparison.empty())
    standard_output::print("compared with the previous baseline: {}\n", update.comparison);
  status::tell("wrote {} and recorded it in {}\n", output.string(),
               comparison::baseline_log(output).string());
  return ExitCode::success;
}

}  // namespace

commands::Command baseline_command() {
  return {
      {"baseline",
       "FILE -o OUTPUT --reason TEXT",
       {command_line::renewed_file({"output,o", "OUTPUT", "the baseline to make or to replace (required)"}),
        {"reason", "TEXT", "the reason, for the log (required)"}}},
      "make a results file the baseline of later comparisons",
      baseline_help,
      baseline};
}

}  // namespace zerocount::result_commands
