#include "runners/commands/command.hpp"

#include <string>

#include "analysis/trials/theory/plausibility.hpp"
#include "core/failure/failure.hpp"
#include "results/reading/results_file.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/status/status.hpp"

namespace zerocount::commands {

void print_fallback_lock(const storage::OutputLock& lock, const std::filesystem::path& output) {
  if (!lock.owner()) return;
  status::tell("{}: the file system has no locks (flock); {} keeps other commands away from this output\n",
               output.string(), lock.owner()->path().filename().string());
}

ExitCode exit_code_of(goal::Status status) {
  switch (status) {
    case goal::Status::met:
      return ExitCode::success;
    case goal::Status::missed:
      return ExitCode::regression;
    case goal::Status::undecided:
      break;
  }
  return ExitCode::inconclusive;
}

void print_warnings(const study::Study& study) {
  for (const std::string& warning : study.warnings) status::tell("warning: {}\n", warning);
  for (const std::string& warning : theory::doubtful_loops(study)) status::tell("warning: {}\n", warning);
  for (const std::string& warning : theory::doubtful_goals(study)) status::tell("warning: {}\n", warning);
}

}  // namespace zerocount::commands
