#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace zerocount::study_run {

/// A request to stop that comes after a time, unless it is destroyed before.
class Deadline {
 public:
  explicit Deadline(std::chrono::duration<double> time)
      : timer_([this, time](const std::stop_token& destroyed) {
          std::mutex mutex;
          std::unique_lock lock(mutex);
          std::condition_variable_any ended;
          ended.wait_for(lock, destroyed, time, [] { return false; });
          if (!destroyed.stop_requested()) passed_.request_stop();
        }) {}

  std::stop_token token() const { return passed_.get_token(); }

 private:
  std::stop_source passed_;
  std::jthread timer_;
};

}  // namespace zerocount::study_run
