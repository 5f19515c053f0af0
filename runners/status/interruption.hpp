#pragma once

#include <stop_token>
#include <thread>

namespace zerocount::status {

/// Turns SIGINT, SIGTERM, SIGHUP (the terminal has closed), SIGXCPU (the limit of processor time) and SIGUSR1
/// (the warning of a batch system) into a request to stop during its lifetime. A second SIGINT or SIGTERM
/// ends the process at once, with the exit code of an interruption.
///
/// Construct it before other threads are started, because threads inherit the set of blocked signals.
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

}  // namespace zerocount::status
