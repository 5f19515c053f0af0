#pragma once

#include <algorithm>
#include <chrono>

namespace zerocount::study_run {

/// Tells when the trials that wait in memory should be written. They wait a tenth of the elapsed time of the
/// run, within bounds: a crash then loses little, and a long run does not create thousands of files.
class ShardClock {
 public:
  void begin_shard() { shard_begun_ = Clock::now(); }

  bool waited_enough() const {
    constexpr std::chrono::duration<double> shortest_wait{0.5};
    constexpr std::chrono::duration<double> longest_wait{20.0};
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> proportion = 0.1 * (now - run_begun_);
    return now - shard_begun_ >= std::clamp(proportion, shortest_wait, longest_wait);
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point run_begun_{Clock::now()};
  Clock::time_point shard_begun_{run_begun_};
};

}  // namespace zerocount::study_run
