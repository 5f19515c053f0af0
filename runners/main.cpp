#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "runners/program/commands.hpp"
#include "runners/status/status.hpp"

namespace {

using zerocount::ExitCode;

ExitCode say(ExitCode code, const std::string& message) {
  zerocount::status::write_fitted(message.ends_with('\n') ? message : message + "\n");
  return code;
}

/// Ends the program after a failed write to standard output. If the reader has closed its end of the pipe, as
/// head does, it wants no more: the process then ends by SIGPIPE, as the system would have ended it.
/// Otherwise prints the reason.
/// @param error errno of the write
ExitCode end_without_output(int error) {
  if (error == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  return say(ExitCode::machine_failed,
             "zerocount: standard output cannot be written: " + std::generic_category().message(error));
}

ExitCode say_no_thread() {
  return say(
      ExitCode::machine_failed,
      "zerocount: no further thread can be started: this user has as many threads and processes as the "
      "system allows (ulimit -u); end others, or raise the limit");
}

ExitCode run(const std::vector<std::string>& words) {
  try {
    const ExitCode code = zerocount::program::run_command_line(words);
    // Some file systems report a failed write only when the file is closed. EBADF: there is no standard
    // output, so nothing is lost.
    if (std::fflush(stdout) != 0 || (std::fclose(stdout) != 0 && errno != EBADF))
      return end_without_output(errno);
    return code;
  } catch (const zerocount::Failure& failure) {
    return say(failure.code(), failure.what());
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return end_without_output(error.code().value());
    if (error.code() == std::errc::resource_unavailable_try_again) return say_no_thread();
    return say(ExitCode::machine_failed, "zerocount: the system failed: " + error.code().message());
  } catch (const std::bad_alloc&) {
    return say(ExitCode::machine_failed, "zerocount: out of memory");
  } catch (const std::exception& error) {
    // So oneTBB reports that a thread cannot start: a std::runtime_error without a code.
    if (std::string_view(error.what()).starts_with("pthread_create")) return say_no_thread();
    return say(ExitCode::machine_failed,
               "zerocount: an unexpected internal error; this is a fault of the program");
  }
}

extern "C" void end_interrupted(int) {
  _exit(static_cast<int>(ExitCode::interrupted));
}

/// Lets SIGINT and SIGTERM end the process with the exit code of an interruption. This is meant for commands
/// that have nothing to keep or remove. Other commands watch these signals themselves
/// (status::InterruptionWatch). Signals that the parent process ignores stay ignored.
void end_by_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    if (std::signal(signal, end_interrupted) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

/// Opens /dev/null in place of each standard stream that is closed. Otherwise a file opened later could get
/// the descriptor of a standard stream, and the messages written to this stream would go into the file.
/// Reading and writing the streams fails as before.
void occupy_closed_streams() {
  int descriptor = 0;
  do {
    descriptor = open("/dev/null", O_RDONLY | O_CLOEXEC);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor > STDERR_FILENO) close(descriptor);
}

}  // namespace

int main(int count, char** words) {
  // A write beyond the file size limit must fail and be reported; the signal would kill the process silently.
  std::signal(SIGXFSZ, SIG_IGN);
  // A reader of the messages that ends, such as tee or head, stops nothing.
  std::signal(SIGPIPE, SIG_IGN);
  // Where the parent ignored it, the ends of child processes would be lost.
  std::signal(SIGCHLD, SIG_DFL);
  end_by_signals();
  occupy_closed_streams();
  return static_cast<int>(run({words + 1, words + count}));
}
