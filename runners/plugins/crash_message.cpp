#include "runners/plugins/crash_message.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace zerocount::plugins {
namespace {

/// Message that the handler of crash signals prints. It is prepared before a crash, because such a handler
/// may not allocate memory.
std::array<char, 4096> crash_message{};

extern "C" void print_message_and_end(int signal) {
  // Nothing can be done where standard error cannot be written.
  [[maybe_unused]] const ssize_t written =
      ::write(STDERR_FILENO, crash_message.data(), std::strlen(crash_message.data()));
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

}  // namespace

void name_in_crashes(const std::filesystem::path& library) {
  const std::string text = fmt::format(
      "zerocount: the process crashed after it had loaded the controller {}; the cause is most likely in "
      "this library, for example memory outside its state; run it in a debugger\n",
      library.string());
  const std::size_t size = std::min(text.size(), crash_message.size() - 1);
  *std::copy_n(text.begin(), size, crash_message.begin()) = '\0';
  struct sigaction action {};
  action.sa_handler = print_message_and_end;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
}

}  // namespace zerocount::plugins
