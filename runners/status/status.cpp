#include "runners/status/status.hpp"

#include <cstdio>

#include <unistd.h>

namespace zerocount::status {
namespace {

constexpr std::chrono::milliseconds terminal_interval{200};
constexpr std::chrono::milliseconds log_interval{5000};
constexpr std::string_view clear_line = "\r\x1b[K";

}  // namespace

void write(std::string_view text) {
  // Nothing depends on what stderr says: a full disk or a closed stream there is not reported.
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

StatusLine::StatusLine(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), last_(Clock::now()) {}

StatusLine::~StatusLine() {
  if (shown_) write(clear_line);
}

void StatusLine::show(const std::function<std::string()>& text) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < (terminal_ ? terminal_interval : log_interval)) return;
  last_ = now;
  if (terminal_) {
    write(std::string(clear_line) + text());
    shown_ = true;
  } else {
    write(text() + "\n");
  }
}

void StatusLine::finish(std::string_view text) {
  if (quiet_) return;
  write(fmt::format("{}{}\n", terminal_ ? clear_line : "", text));
  shown_ = false;
}

}  // namespace zerocount::status
