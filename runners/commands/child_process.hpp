#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount {

/// What another program said.
struct ChildResult {
  int code{0};      ///< exit code; 128 + signal where a signal ended it
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// Runs a program of the search path with these words, gives it `input`, and waits for its end. Nothing where
/// there is no such program.
/// @throws Failure (machine_failed) where it cannot be started for another reason.
std::optional<ChildResult> run_child(const std::vector<std::string>& words, std::string_view input);

}  // namespace zerocount
