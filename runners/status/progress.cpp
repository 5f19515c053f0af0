#include "runners/status/progress.hpp"

#include <cmath>
#include <csignal>
#include <ctime>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "core/failure/failure.hpp"

namespace zerocount::status {

namespace {

/// The signals that end a run, without those that the process inherited as ignored, as SIGHUP with nohup.
sigset_t watched_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1}) {
    struct sigaction present {};
    sigaction(signal, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  return signals;
}

/// Whether somebody who sends the signal again wants the end at once. The system repeats SIGXCPU every
/// second, and sends SIGHUP beside SIGTERM.
bool is_of_user(int signal) {
  return signal == SIGINT || signal == SIGTERM;
}

}  // namespace

InterruptionWatch::InterruptionWatch() {
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([this, signals](const std::stop_token& done) {
    const timespec patience{0, 50'000'000};  // ns
    bool asked = false;
    while (!done.stop_requested()) {
      const int signal = sigtimedwait(&signals, nullptr, &patience);
      if (signal < 0) continue;
      interrupted_.request_stop();
      if (!is_of_user(signal)) continue;
      if (asked) _exit(static_cast<int>(ExitCode::interrupted));
      asked = true;
    }
  });
}

InterruptionWatch::~InterruptionWatch() {
  watcher_.request_stop();
  watcher_.join();
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

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
