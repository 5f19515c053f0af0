#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::trials {

/// Order in which the rows of a sweep run. The design points take turns, so that at any time the finished
/// trials compare all points.
///
///     while rows remain
///       choose the point with the fewest trials, the first of several
///       take its next rows, until end_turn() or its last row
///
/// After the last row of a point, its turn goes on with the next point.
class Turns {
 public:
  /// @param ranges ranges of rows to run, ascending and without overlaps; other trials of their points count
  /// as run
  /// @param trials number of trials of each point
  Turns(std::span<const layout::RowRange> ranges, std::int64_t trials);

  bool is_empty() const { return !current_; }
  /// Number of points that have rows in the ranges.
  std::int64_t points() const { return static_cast<std::int64_t>(points_.size()); }

  /// The next contiguous rows, at most `max_rows`. They belong to one point, or are all that remain of
  /// several.
  layout::RowRange upcoming(std::int64_t max_rows) const;

  /// Takes the first `count` of the upcoming rows.
  void take(std::int64_t count);

  /// Whether the last rows taken were the last of their point.
  bool is_at_new_point() const { return at_new_point_; }

  /// Ends the turn of the current point.
  void end_turn();

 private:
  struct PointRows {
    std::int64_t trials_run{0};
    std::vector<layout::RowRange> remaining;  ///< Non-empty ranges, the last one first.
  };

  void choose_point();

  std::vector<PointRows> points_;
  std::optional<std::size_t> current_;  ///< Index of the point whose turn it is.
  /// Waiting points: number of trials run, index.
  std::set<std::pair<std::int64_t, std::size_t>> waiting_{};
  bool at_new_point_{false};
};

/// Duration of one turn of a point, s.
///
/// One turn of every point takes a fifth of the elapsed time of the run, and a turn of one point at most a
/// tenth. The duration also has a minimum and a maximum. Each turn ends a shard, which takes 10 to 20 ms to
/// write and join, one thread at a time. This is at most half a percent of four seconds of a thread, the
/// length to which the first turns grow. A crash loses a turn, and a long run does not create thousands of
/// shards per point.
inline double turn_seconds(double elapsed, std::int64_t points, int threads) {
  constexpr double of_all_points = 0.2;
  constexpr double shortest_of_all = 0.5, longest = 20.0;
  const double shortest = std::clamp(elapsed, shortest_of_all, std::max(shortest_of_all, 4.0 / threads));
  const double one = of_all_points * elapsed / static_cast<double>(std::max<std::int64_t>(points, 2));
  return std::clamp(one, shortest, longest);
}

/// Clock that tells when a turn should end.
class TurnClock {
 public:
  /// @param points number of points that take turns
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

/// Maximum number of trials of a block, in a run of `rows` trials.
std::int64_t max_block_rows(const study::Study& study, std::int64_t rows, int threads);

/// Maximum memory of the traces of a block, bytes.
double max_block_traces(const study::Study& study);

/// Rows that one thread runs in one go.
struct Block {
  layout::RowRange rows;
  bool begins_turn{false};
};

/// Divides the rows of all turns into blocks. A block ends with a chunk of the results file, and has fewer
/// trials where many of them are retained with their traces. The last blocks become smaller, so that the
/// threads end together. Slow trials make small blocks: the first ones are small, and the later ones have at
/// most as many trials as took a second. The data of the trials do not depend on their blocks.
class BlockSource {
 public:
  /// @param study must outlive this object
  /// @param ranges ranges of rows to run, ascending and without overlaps
  BlockSource(const study::Study& study, std::span<const layout::RowRange> ranges, int threads);

  /// The next block; nothing after the last one.
  std::optional<Block> next();

  /// Notes how long the trials of a block took. Any thread may call it. The time of slow trials is forgotten
  /// step by step, because slow and fast points may alternate.
  /// @param seconds time that one thread took for all trials of the block, s
  void note(std::int64_t trials, double seconds) {
    trial_seconds_ = std::max(seconds / static_cast<double>(trials), 0.5 * trial_seconds_);
  }

 private:
  std::int64_t next_row() const { return turns_.upcoming(1).first; }
  double end_of_turn() const;
  layout::RowRange with_few_traces(layout::RowRange rows) const;
  std::int64_t max_quick_rows() const;

  const study::Study& study_;
  Turns turns_;
  TurnClock clock_;
  std::int64_t max_rows_;        ///< Maximum number of trials of a block.
  std::int64_t max_first_rows_;  ///< Maximum number of trials of a block until the time of a trial is known.
  /// Mean time of a trial in the block that ended last, but at least half of the value before, s. 0: no block
  /// has ended.
  std::atomic<double> trial_seconds_{0.0};
  int threads_;
  std::int64_t remaining_;  ///< Number of remaining rows.
  double trace_bytes_;      ///< Memory of the trace of one retained trial, bytes.
};

}  // namespace zerocount::trials
