#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "core/text/utf8.hpp"
#include "runners/commands/commands.hpp"

namespace {

using zerocount::ExitCode;

ExitCode say(ExitCode code, const std::string& message) {
  // A name in the message may hold what a terminal would obey.
  const std::string shown = zerocount::text::printable_lines(message);
  std::fprintf(stderr, "%s%s", shown.c_str(), shown.ends_with('\n') ? "" : "\n");
  return code;
}

ExitCode run(const std::vector<std::string>& words) {
  try {
    const ExitCode code = zerocount::commands::run_command_line(words);
    const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    // Some file systems report a failed write only here. EBADF: there is no standard output, so nothing is
    // lost.
    if (failed || (std::fclose(stdout) != 0 && errno != EBADF)) {
      return say(ExitCode::machine_failed, "zerocount: standard output cannot be written");
    }
    return code;
  } catch (const zerocount::Failure& failure) {
    return say(failure.code(), failure.what());
  } catch (const std::system_error& error) {
    const char* what = std::ferror(stdout) != 0 ? "standard output cannot be written" : "the system failed";
    return say(ExitCode::machine_failed, std::string("zerocount: ") + what + ": " + error.code().message());
  } catch (const std::bad_alloc&) {
    return say(ExitCode::machine_failed, "zerocount: out of memory");
  } catch (const std::exception&) {
    return say(ExitCode::machine_failed,
               "zerocount: an unexpected internal error; this is a fault of the program");
  }
}

/// Takes the places of closed standard streams, so that no file opened later gets one of them, and with it
/// what is written to the stream. Reading and writing them fails as before.
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
  // Where the parent ignored it, the ends of child processes would be lost.
  std::signal(SIGCHLD, SIG_DFL);
  occupy_closed_streams();
  return static_cast<int>(run({words + 1, words + count}));
}
