#include "runners/status/interruption.hpp"

#include <csignal>
#include <ctime>

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

}  // namespace zerocount::status
