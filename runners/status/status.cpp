#include "runners/status/status.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include "analysis/basis/text/text.hpp"
#include "runners/terminal/terminal.hpp"

namespace zerocount::status {
namespace {

constexpr std::chrono::milliseconds terminal_interval{200};
constexpr std::chrono::milliseconds first_log_interval{5000};
constexpr std::chrono::hours last_log_interval{1};
constexpr std::string_view clear_line = "\r\x1b[K";

}  // namespace

void write(std::string_view text) {
  // Nothing depends on what stderr says: a full disk or a closed stream there is not reported.
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void write_fitted(std::string_view text) {
  write(terminal::fitted_to(STDERR_FILENO, text));
}

StatusLine::StatusLine(bool quiet, Listener listener)
    : quiet_(quiet),
      listener_(std::move(listener)),
      terminal_(terminal::obeys_escapes(STDERR_FILENO)),
      interval_(terminal_ ? terminal_interval : first_log_interval),
      last_(Clock::now()) {}

StatusLine::~StatusLine() {
  clear();
}

void StatusLine::show(const std::function<std::string()>& text) {
  if (listener_) listener_(text());
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < interval_) return;
  last_ = now;
  if (terminal_) {
    // The last column stays free: some terminals go to the next line there.
    const std::optional<std::size_t> width = terminal::width_of(STDERR_FILENO);
    write(std::string(clear_line) + (width ? text::shortened(text(), *width - 1) : text()));
    shown_ = true;
  } else {
    write_fitted(text() + "\n");
    interval_ = std::min<Clock::duration>(2 * interval_, last_log_interval);
  }
}

void StatusLine::finish(std::string_view text) {
  if (listener_) listener_(std::string(text));
  if (quiet_) return;
  clear();
  write_fitted(fmt::format("{}\n", text));
}

void StatusLine::clear() {
  if (shown_) write(clear_line);
  shown_ = false;
}

}  // namespace zerocount::status
