#include "tests/runners/program.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// Starts the program with these words of the command line; its output goes to the files `out` and `err`.
/// @return process id
pid_t start(const std::vector<std::string>& words, const fs::path& directory, const fs::path& out,
            const fs::path& err, const std::vector<std::string>& environment = {}) {
  const pid_t process = fork();
  if (process != 0) return process;
  const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (chdir(directory.c_str()) != 0 || dup2(out_file, STDOUT_FILENO) < 0 ||
      dup2(err_file, STDERR_FILENO) < 0) {
    _exit(126);
  }
  std::vector<char*> arguments{const_cast<char*>(ZEROCOUNT_PROGRAM)};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  for (const std::string& variable : environment) putenv(const_cast<char*>(variable.c_str()));
  execv(arguments[0], arguments.data());
  _exit(127);
}

int wait_for(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ProgramResult zerocount_program(const std::vector<std::string>& words, const fs::path& directory,
                                const std::vector<std::string>& environment) {
  const TemporaryFolder outputs;
  const fs::path out = outputs.path() / "out";
  const fs::path err = outputs.path() / "err";
  const int code = wait_for(start(words, directory, out, err, environment));
  return {code, read_bytes(out), read_bytes(err)};
}

nlohmann::json ProgramTest::json_of(std::vector<std::string> words, std::optional<int> code) const {
  words.insert(words.end(), {"--format", "json"});
  const ProgramResult result = program(words);
  EXPECT_EQ(result.code, code.value_or(result.code)) << result.out << result.err;
  return nlohmann::json::parse(result.out, nullptr, false);
}

std::string ProgramTest::refusal(const std::vector<std::string>& words, int code) const {
  const ProgramResult result = program(words);
  EXPECT_EQ(result.code, code) << result.out << result.err;
  return result.err;
}

RunningProgram::RunningProgram(const std::vector<std::string>& words, const fs::path& directory,
                               const fs::path& out)
    : process_(start(words, directory, out, "/dev/null")) {}

void RunningProgram::send(int signal) const {
  kill(process_, signal);
}

std::ptrdiff_t shards_in(const fs::path& folder) {
  if (!fs::exists(folder)) return 0;
  return std::count_if(fs::directory_iterator(folder), fs::directory_iterator(),
                       [](const fs::directory_entry& file) { return file.path().extension() == ".shard"; });
}

void RunningProgram::wait_for_shards(const fs::path& folder, std::ptrdiff_t number) const {
  while (shards_in(folder) < number) {
    siginfo_t ended{};
    waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (ended.si_pid != 0) throw std::runtime_error("the program ended before it wrote a shard");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int RunningProgram::wait() {
  return wait_for(process_);
}

std::string small_manifest(int trials, const std::string& more) {
  return "zerocount: 1\nname: small\nseed: 42\ntrials: " + std::to_string(trials) +
         "\n"
         "friction:\n"
         "  k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2, marginal: lognormal}}\n"
         "  k2: {uniform: [600, 900]}\n"
         "  lambda: 0.5\n"
         "command: {targets: [{integers: [1, 10]}], hold: 0.15}\n"
         "initial: {encoder_phase: {uniform: [0, 1]}, position: {uniform: [0, 6.283185307179586]}}\n"
         "verdict: {dwell: 0.02, window: 0.02}\n"
         "sweep: {cases: {low: {controller.ki: 3.85e-5}, high: {controller.ki: 2.08e-4}}}\n" +
         more;
}

}  // namespace zerocount::testing
