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

/// The order in which the rows of a sweep run: its points take turns, so that the trials so far compare all
/// of them.
///
///     while rows remain
///       choose the point with the fewest trials, the first of several
///       take its next rows, until end_turn() or its last row
///
/// A turn goes on with the next point after the last row of one.
class Turns {
 public:
  /// @param ranges in order of rows, without overlaps; the other trials of their points count as run.
  /// @param trials of each point
  Turns(std::span<const layout::RowRange> ranges, std::int64_t trials);

  bool is_empty() const { return !current_; }
  /// Number of points that have rows in the ranges.
  std::int64_t points() const { return static_cast<std::int64_t>(points_.size()); }

  /// The next rows that follow one another, at most `max_rows`: of one point, or all that remain of several.
  layout::RowRange upcoming(std::int64_t max_rows) const;

  /// Takes the first `count` of the upcoming rows.
  void take(std::int64_t count);

  /// Whether the last rows taken were the last of their point.
  bool is_at_new_point() const { return at_new_point_; }

  /// Ends the turn of the present point.
  void end_turn();

 private:
  struct PointRows {
    std::int64_t trials_run{0};
    std::vector<layout::RowRange> remaining;  ///< not empty ranges, the last one first
  };

  void choose_point();

  std::vector<PointRows> points_;
  std::optional<std::size_t> current_;                        ///< index of the point whose turn it is
  std::set<std::pair<std::int64_t, std::size_t>> waiting_{};  ///< the others: trials run, index
  bool at_new_point_{false};
};

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

/// Number of trials of a block at most, in a run of `rows` trials.
std::int64_t max_block_rows(const study::Study& study, std::int64_t rows, int threads);

/// Memory of the traces of a block at most, bytes.
double max_block_traces(const study::Study& study);

/// Rows that one thread runs.
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
  /// @param study stays as long as this @param ranges as for Turns
  BlockSource(const study::Study& study, std::span<const layout::RowRange> ranges, int threads);

  /// The next block; none behind the last one.
  std::optional<Block> next();

  /// Tells how long the trials of a block took. Any thread may call it. Slow trials are forgotten step by
  /// step, because slow and fast points may alternate.
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
  std::int64_t max_rows_;                   ///< of a block
  std::int64_t max_first_rows_;             ///< of a block, until the time of a trial is known
  std::atomic<double> trial_seconds_{0.0};  ///< of the block that ended last; 0: none has ended
  int threads_;
  std::int64_t remaining_;  ///< rows
  double trace_bytes_;      ///< of one retained trial
};

}  // namespace zerocount::trials
