#pragma once

#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {

using Json = nlohmann::json;

/// Result of a finished program.
struct ProgramResult {
  int code{0};      ///< exit code; 128 + signal number if a signal ended the program
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

/// Runs `zerocount` with these words, in `directory`, and waits for it.
/// @param environment further variables, as NAME=VALUE
ProgramResult zerocount_program(const std::vector<std::string>& words, const std::filesystem::path& directory,
                                const std::vector<std::string>& environment = {});

/// A test that runs `zerocount` in its own temporary folder.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramResult program(const std::vector<std::string>& words) const {
    return zerocount_program(words, folder_.path());
  }
  /// Runs the program and returns its output, parsed as JSON.
  /// @param code expected exit code; empty: any
  nlohmann::json json_of(std::vector<std::string> words, std::optional<int> code = {}) const;
  /// Runs a command that must end with this exit code, and returns its error message.
  std::string refusal(const std::vector<std::string>& words, int code = 2) const;

  TemporaryFolder folder_;
};

/// A running `zerocount` process.
class RunningProgram {
 public:
  /// Starts `zerocount` with these words in `directory`.
  /// @param out file for its standard output
  RunningProgram(const std::vector<std::string>& words, const std::filesystem::path& directory,
                 const std::filesystem::path& out = "/dev/null");
  void send(int signal) const;

  /// Waits until the folder has `number` shards of its run. It is an error if the program ends before.
  void wait_for_shards(const std::filesystem::path& folder, std::ptrdiff_t number = 1) const;

  int wait();  ///< exit code; 128 + signal number if a signal ended the program

 private:
  pid_t process_;
};

/// Number of shards in a folder; 0 if the folder does not exist.
std::ptrdiff_t shards_in(const std::filesystem::path& folder);

/// A small study with random friction, two cases and jerks: 2 × `trials` trials of 300 samples.
std::string small_manifest(int trials, const std::string& more = "");

}  // namespace zerocount::testing
