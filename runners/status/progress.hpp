#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "runners/status/status.hpp"

namespace zerocount::status {

/// Prints the progress of a run to stderr, and a final line.
class Progress {
 public:
  /// @param total trials to run @param kept trials of earlier runs @param samples per trial, for the rate
  Progress(std::int64_t total, std::int64_t kept, double samples, bool quiet, Listener listener = {});

  /// Sets a projected total, which may change again.
  void project(std::int64_t total);
  /// `done` trials of the total are finished.
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

/// A duration as text: "850 ms", "12 s", "3 min 20 s", "5 h 02 min".
std::string duration_text(double seconds);

}  // namespace zerocount::status
