#include <chrono>
#include <csignal>
#include <optional>
#include <utility>

#include <unistd.h>

#include "core/failure/failure.hpp"
#include "runners/status/progress.hpp"

namespace zerocount::status {
namespace {

/// Signals that end a run, without those that the process inherited as ignored (such as SIGHUP under nohup).
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

using Clock = std::chrono::steady_clock;

/// Time after the first signal in which further signals belong to the same request to stop. `timeout` of the
/// GNU core utilities, for example, sends its signal to the process and then to the process group.
constexpr std::chrono::seconds one_request{1};

/// Time that work without anything to keep has to stop by itself after a signal. Then the process is ended.
constexpr std::chrono::milliseconds time_to_stop{500};

[[noreturn]] void end_interrupted() {
  _exit(static_cast<int>(ExitCode::interrupted));
}

/// Whether this signal, sent once more, means that the user wants the end at once. SIGINT and SIGTERM do. The
/// system repeats SIGXCPU every second, and sends SIGHUP beside SIGTERM.
bool is_of_user(int signal) {
  return signal == SIGINT || signal == SIGTERM;
}

}  // namespace

InterruptionWatch::InterruptionWatch(Unstopped unstopped, std::function<void()> before_end) {
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread(
      [this, signals, unstopped, before_end = std::move(before_end)](const std::stop_token& done) {
        const timespec patience{0, 50'000'000};  // ns
        const auto end = [&] {
          if (before_end) before_end();
          end_interrupted();
        };
        std::optional<Clock::time_point> first_of_user;
        std::optional<Clock::time_point> first;
        while (!done.stop_requested()) {
          const int signal = sigtimedwait(&signals, nullptr, &patience);
          const Clock::time_point now = Clock::now();
          if (unstopped == Unstopped::end && first && now - *first > time_to_stop) end();
          if (signal < 0) continue;
          if (!first) first = now;
          interrupted_.request_stop();
          if (!is_of_user(signal)) continue;
          if (!first_of_user) first_of_user = now;
          if (now - *first_of_user > one_request) end();
        }
      });
}

InterruptionWatch::~InterruptionWatch() {
  watcher_.request_stop();
  watcher_.join();
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace zerocount::status
