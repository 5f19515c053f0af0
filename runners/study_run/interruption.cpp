#include "runners/study_run/interruption.hpp"

#include <csignal>
#include <ctime>

#include <unistd.h>

#include "core/failure/failure.hpp"

namespace zerocount::study_run {
namespace {

/// SIGINT and SIGTERM, without signals that the process inherited as ignored.
sigset_t watched_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction present {};
    sigaction(signal, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  return signals;
}

}  // namespace

InterruptionWatch::InterruptionWatch() {
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([this, signals](const std::stop_token& done) {
    const timespec patience{0, 50'000'000};  // ns
    while (!done.stop_requested()) {
      if (sigtimedwait(&signals, nullptr, &patience) < 0) continue;
      if (interrupted_.stop_requested()) _exit(static_cast<int>(ExitCode::interrupted));
      interrupted_.request_stop();
    }
  });
}

InterruptionWatch::~InterruptionWatch() {
  watcher_.request_stop();
  watcher_.join();
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace zerocount::study_run
