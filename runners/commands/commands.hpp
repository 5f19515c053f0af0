#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/study.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// One verb of the command line.
struct Command {
  command_line::CommandSpec spec;
  std::string summary;  ///< one line
  std::string help;     ///< complete description with examples
  ExitCode (*run)(const command_line::Arguments&){nullptr};
  std::vector<document::AnswerType> answers{};  ///< that it gives; empty where it answers no question
};

Command check_command();
Command run_command();
Command summary_command();
Command trace_command();
Command merge_command();
Command new_command();
Command verify_command();
Command export_command();
Command compare_command();
Command baseline_command();
Command history_command();
Command jerks_command();
Command judge_command();
Command learn_command();
Command tune_command();
Command limits_command();
Command controller_command();
Command worst_command();
Command rare_command();
Command plan_command();
Command experiment_command();
Command identify_command();
Command sensitivity_command();
Command slurm_command();
Command status_command();
Command report_command();
Command plot_command();
Command parameters_command();
Command schema_command();
Command completion_command();
Command manual_command();

/// Prints to stderr that the lock is a file with an owner, if it is.
void print_fallback_lock(const storage::OutputLock& lock, const std::filesystem::path& output);

/// Prints the warnings about the manifest and its loops to stderr.
void print_warnings(const study::Study& study);

/// success for a goal that is met, regression for one that is missed, inconclusive.
ExitCode exit_code_of(goal::Status status);

/// All verbs, in the order of the help.
std::vector<Command> commands();

/// Runs the program with its command-line arguments.
/// @throws Failure with the message for the user and the exit code.
ExitCode run_command_line(std::span<const std::string> words);

}  // namespace zerocount::commands
