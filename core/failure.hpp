#pragma once

#include <stdexcept>
#include <string>

namespace zerocount {

/// What the process tells its caller: the one list of exit codes.
enum class ExitCode : int {
  success = 0,         ///< done, or the gate passed
  regression = 1,      ///< a statistical regression was found
  bad_input = 2,       ///< bad usage or a bad manifest
  inconclusive = 3,    ///< too little data to decide
  bad_data = 4,        ///< a results file is incomplete, corrupt or incompatible
  machine_failed = 5,  ///< I/O or memory
  interrupted = 130    ///< SIGINT or SIGTERM; what is finished is kept
};

/// Something that ends the command: a message for the user, complete in itself, and the exit code that goes
/// with it.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace zerocount
