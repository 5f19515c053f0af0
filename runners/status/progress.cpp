#include "runners/status/progress.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace zerocount::status {
namespace {

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

Progress::Progress(std::int64_t total, std::int64_t kept, double samples, bool quiet, Listener listener)
    : total_(total),
      kept_(kept),
      samples_(samples),
      line_(quiet, std::move(listener)),
      start_(Clock::now()) {}

std::string Progress::text(std::int64_t done, double elapsed) const {
  const double proportion =
      total_ > 0 ? 100.0 * static_cast<double>(done) / static_cast<double>(total_) : 100.0;
  std::string words =
      fmt::format("{} of {}{} trials ({:.1f} %)", done, projected_ ? "about " : "", total_, proportion);
  if (kept_ > 0) words += fmt::format(", {} of them from before", kept_);
  const double rate = elapsed > 0.0 ? static_cast<double>(done - kept_) / elapsed : 0.0;
  if (rate > 0.0) {
    words += fmt::format(", {:.4g} trials/s, {:.3g} M samples/s", rate, 1e-6 * rate * samples_);
    if (done < total_) words += ", " + duration_text(static_cast<double>(total_ - done) / rate) + " to go";
  }
  return words;
}

void Progress::project(std::int64_t total) {
  total_ = total;
  projected_ = true;
}

void Progress::update(std::int64_t done) {
  line_.show([&] { return text(done, seconds(Clock::now() - start_)); });
}

void Progress::finish(std::int64_t done) {
  const double elapsed = seconds(Clock::now() - start_);
  line_.finish(fmt::format("{}, in {}", text(done, elapsed), duration_text(elapsed)));
}

std::string duration_text(double seconds) {
  if (seconds < 1.0) return fmt::format("{:.0f} ms", 1e3 * seconds);
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace zerocount::status
