#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/study_fwd.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// One verb of the command line.
struct Command {
  command_line::CommandSpec spec;
  std::string summary;  ///< one line
  std::string help;     ///< complete description with examples
  ExitCode (*run)(const command_line::Arguments&){nullptr};
  /// Types of answers that it gives; null where it answers no question. A type takes long to describe.
  std::vector<document::AnswerType> (*answers)(){nullptr};
};

/// Prints to stderr that the lock is a file with an owner, if it is.
void print_fallback_lock(const storage::OutputLock& lock, const std::filesystem::path& output);

/// Prints the warnings about the manifest and its loops to stderr.
void print_warnings(const study::Study& study);

/// success for a goal that is met, regression for one that is missed, inconclusive.
ExitCode exit_code_of(goal::Status status);

}  // namespace zerocount::commands
