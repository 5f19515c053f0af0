#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "runners/status/status.hpp"

namespace zerocount::status {

/// Turns signals into a request to stop, during the lifetime of this object. The signals are SIGINT, SIGTERM,
/// SIGHUP (the terminal has closed), SIGXCPU (the limit of processor time) and SIGUSR1 (the warning of a
/// batch system). Signals within a second after the first one belong to the same request. A later SIGINT or
/// SIGTERM ends the process at once, with the exit code of an interruption.
///
/// The object must be constructed before other threads start, because threads inherit the set of blocked
/// signals.
class InterruptionWatch {
 public:
  /// Treatment of work that does not stop soon after a signal.
  enum class Unstopped : std::uint8_t {
    wait,  ///< The work goes on until it stops by itself, because it has something to keep or to remove.
    end    ///< The process is ended, with the exit code of an interruption. Nothing is lost by this.
  };

  /// @param before_end is called in the thread of the watch before this object ends the process
  /// (Unstopped::end, or a second SIGINT or SIGTERM), for example to remove temporary files. It must not wait
  /// for the work. May be empty.
  explicit InterruptionWatch(Unstopped unstopped = Unstopped::wait, std::function<void()> before_end = {});
  InterruptionWatch(const InterruptionWatch&) = delete;
  InterruptionWatch& operator=(const InterruptionWatch&) = delete;
  ~InterruptionWatch();

  std::stop_token token() const { return interrupted_.get_token(); }

 private:
  std::stop_source interrupted_;
  std::jthread watcher_;
};

/// Prints the progress of a run of trials to stderr while it runs, and a final line.
class Progress {
 public:
  /// @param total number of trials to run
  /// @param kept number of trials kept from earlier runs
  /// @param samples mean number of samples per trial, for the speed in samples/s
  /// @param quiet whether to print nothing
  /// @param listener gets each text as well; empty: none
  Progress(std::int64_t total, std::int64_t kept, double samples, bool quiet, Listener listener = {});

  /// Replaces the total number of trials by a projection, which may change again.
  void project(std::int64_t total);
  /// Prints the progress, now that `done` trials of the total are finished.
  void update(std::int64_t done);
  void finish(std::int64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string text(std::int64_t done, double elapsed) const;

  std::int64_t total_;
  bool projected_{false};
  std::int64_t kept_;
  double samples_;
  status::StatusLine line_;
  Clock::time_point start_;
};

/// Text of a duration, such as "850 ms", "12 s", "3 min 20 s" or "5 h 02 min".
/// @param seconds duration, s
std::string duration_text(double seconds);

}  // namespace zerocount::status
