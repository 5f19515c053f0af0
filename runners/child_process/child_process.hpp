#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::child_process {

/// Exit code and output of a child process.
struct ChildResult {
  int code{0};      ///< Exit code of the process; 128 + signal number if a signal ended it.
  std::string out;  ///< Text that the process wrote to standard output.
  std::string err;  ///< Text that the process wrote to standard error.
};

/// Runs a program, which is sought on the search path, and waits for its end. Returns nothing if the program
/// does not exist.
/// @param words name of the program, and its arguments
/// @param input text that the program reads from standard input
/// @throws Failure (machine_failed) if it cannot be started for another reason.
std::optional<ChildResult> run_child(const std::vector<std::string>& words, std::string_view input);

}  // namespace zerocount::child_process
