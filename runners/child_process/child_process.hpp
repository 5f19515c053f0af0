#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::child_process {

/// Exit code and output of a child process.
struct ChildResult {
  int code{0};      ///< Exit code; 128 + signal if a signal ended the process.
  std::string out;  ///< Standard output.
  std::string err;  ///< Standard error.
};

/// Runs a program from the search path with these arguments and `input` as standard input, and waits for its
/// end. Returns nothing if the program does not exist.
/// @throws Failure (machine_failed) if it cannot be started for another reason.
std::optional<ChildResult> run_child(const std::vector<std::string>& words, std::string_view input);

}  // namespace zerocount::child_process
