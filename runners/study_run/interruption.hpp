#pragma once

#include <stop_token>
#include <thread>

namespace zerocount::study_run {

/// Turns SIGINT and SIGTERM into a request to stop during its lifetime. A second signal ends the process at
/// once, with the exit code of an interruption.
///
/// Construct it before other threads are started, because
/// threads inherit the set of blocked signals.
class InterruptionWatch {
 public:
  InterruptionWatch();
  InterruptionWatch(const InterruptionWatch&) = delete;
  InterruptionWatch& operator=(const InterruptionWatch&) = delete;
  ~InterruptionWatch();

  std::stop_token token() const { return interrupted_.get_token(); }

 private:
  std::stop_source interrupted_;
  std::jthread watcher_;
};

}  // namespace zerocount::study_run
