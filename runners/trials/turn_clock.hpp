#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace zerocount::trials {

/// Time that one turn of a point takes, s.
///
/// All points together take a fifth of the elapsed time of the run, one point at most a tenth, within bounds.
/// A turn ends a shard, which takes 10 to 20 ms to write and join, one thread at a time: at most half a
/// percent of four seconds of a thread, to which the first turns grow. A crash loses a turn, and a long run
/// does not create thousands of shards of a point.
inline double turn_seconds(double elapsed, std::int64_t points, int threads) {
  constexpr double of_all_points = 0.2;
  constexpr double shortest_of_all = 0.5, longest = 20.0;
  const double shortest = std::clamp(elapsed, shortest_of_all, std::max(shortest_of_all, 4.0 / threads));
  const double one = of_all_points * elapsed / static_cast<double>(std::max<std::int64_t>(points, 2));
  return std::clamp(one, shortest, longest);
}

/// Tells when a turn should end.
class TurnClock {
 public:
  /// @param points that take turns
  TurnClock(std::int64_t points, int threads) : points_(points), threads_(threads) {}

  void begin_turn() { turn_begun_ = Clock::now(); }

  /// Proportion of the turn's time that has passed; above 1 it is over.
  double progress() const {
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> elapsed = now - run_begun_;
    const std::chrono::duration<double> of_turn = now - turn_begun_;
    return of_turn.count() / turn_seconds(elapsed.count(), points_, threads_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t points_;
  int threads_;
  Clock::time_point run_begun_{Clock::now()};
  Clock::time_point turn_begun_{run_begun_};
};

}  // namespace zerocount::trials
