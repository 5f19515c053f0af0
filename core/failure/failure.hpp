#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

namespace zerocount {

/// The exit codes of the process, one per kind of failure.
enum class ExitCode : int {
  success = 0,
  regression = 1,
  bad_input = 2,
  inconclusive = 3,
  bad_data = 4,
  machine_failed = 5,
  interrupted = 130
};

struct ExitCodeMeaning {
  ExitCode code;
  std::string_view meaning;
};

inline constexpr std::array exit_code_meanings{
    ExitCodeMeaning{ExitCode::success, "success, the gate passed, or the goal is met"},
    ExitCodeMeaning{ExitCode::regression, "a statistical regression was found, or the goal is missed"},
    ExitCodeMeaning{ExitCode::bad_input, "bad usage or a bad manifest"},
    ExitCodeMeaning{ExitCode::inconclusive, "too little data to decide"},
    ExitCodeMeaning{ExitCode::bad_data, "results incomplete, damaged or incompatible"},
    ExitCodeMeaning{ExitCode::machine_failed, "the machine failed: files or memory"},
    ExitCodeMeaning{ExitCode::interrupted, "interrupted; everything finished is kept"},
};

/// An error that ends the command: a message for the user, complete in itself, and the exit code.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace zerocount
