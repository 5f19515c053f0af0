#include "runners/study_run/progress.hpp"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace zerocount::study_run {
namespace {

constexpr std::chrono::milliseconds terminal_interval{200};
constexpr std::chrono::milliseconds log_interval{5000};

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

Progress::Progress(std::int64_t total, std::int64_t kept, double samples, bool quiet)
    : total_(total),
      kept_(kept),
      samples_(samples),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

std::string Progress::line(std::int64_t done, double elapsed) const {
  const double proportion =
      total_ > 0 ? 100.0 * static_cast<double>(done) / static_cast<double>(total_) : 100.0;
  std::string text =
      fmt::format("{} of {}{} trials ({:.1f} %)", done, projected_ ? "about " : "", total_, proportion);
  if (kept_ > 0) text += fmt::format(", {} of them from before", kept_);
  const double rate = elapsed > 0.0 ? static_cast<double>(done - kept_) / elapsed : 0.0;
  if (rate > 0.0) {
    text += fmt::format(", {:.4g} trials/s, {:.3g} M samples/s", rate, 1e-6 * rate * samples_);
    if (done < total_) text += ", " + duration_text(static_cast<double>(total_ - done) / rate) + " to go";
  }
  return text;
}

void Progress::project(std::int64_t total) {
  total_ = total;
  projected_ = true;
}

void Progress::update(std::int64_t done) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < (terminal_ ? terminal_interval : log_interval)) return;
  last_ = now;
  const std::string text = line(done, seconds(now - start_));
  fmt::print(stderr, "{}{}{}", terminal_ ? "\r\x1b[K" : "", text, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

void Progress::finish(std::int64_t done) {
  if (quiet_) return;
  const double elapsed = seconds(Clock::now() - start_);
  fmt::print(stderr, "{}{}, in {}\n", terminal_ ? "\r\x1b[K" : "", line(done, elapsed),
             duration_text(elapsed));
}

std::string duration_text(double seconds) {
  if (seconds < 1.0) return fmt::format("{:.0f} ms", 1e3 * seconds);
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace zerocount::study_run
