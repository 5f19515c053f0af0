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

/// Order in which the rows (trials) of a sweep over design points run. The points take turns, so that at any
/// time the finished trials compare all points.
///
///     while rows remain
///       choose the point with the fewest trials, the first of several
///       take its next rows, until end_turn() or its last row
///
/// After the last row of a point, its turn goes on with the next point.
class Turns {
 public:
  /// @param ranges ranges of rows (numbers of the trials) to run, ascending and without overlaps; trials
  /// outside the ranges count as already run
  /// @param trials number of trials of each design point
  Turns(std::span<const layout::RowRange> ranges, std::int64_t trials);

  bool is_empty() const { return !current_; }
  /// Number of design points that have rows in the ranges.
  std::int64_t points() const { return static_cast<std::int64_t>(points_.size()); }

  /// The next contiguous rows (trials) to run, at most `max_rows`. They belong to one design point, or to
  /// several points of which they are all the remaining rows.
  layout::RowRange upcoming(std::int64_t max_rows) const;

  /// Removes the first `count` of the upcoming() rows from those that are still to run.
  void take(std::int64_t count);

  /// Whether the rows taken last ended their design point, so that the next row belongs to another one.
  bool is_at_new_point() const { return at_new_point_; }

  /// Ends the turn of the current design point. The next rows are of the point with the fewest trials.
  void end_turn();

 private:
  struct PointRows {
    std::int64_t trials_run{0};
    /// Ranges of the point's rows that are still to run, none of them empty, the last range first.
    std::vector<layout::RowRange> remaining;
  };

  void choose_point();

  std::vector<PointRows> points_;
  /// Index in points_ of the design point whose turn it is; nothing between turns.
  std::optional<std::size_t> current_;
  /// Design points that wait for their turn: number of their trials that were run, index in points_.
  std::set<std::pair<std::int64_t, std::size_t>> waiting_{};
  bool at_new_point_{false};
};

/// Duration of one turn of a design point, s: the time for which the trials of this point run before those of
/// another.
///
/// One turn of every point takes a fifth of the elapsed time of the run, and a turn of one point at most a
/// tenth. The duration also has a minimum and a maximum. Each turn ends a shard file, which takes 10 to 20 ms
/// to write and join, one thread at a time. This is at most half a percent of four seconds of a thread, the
/// length to which the first turns grow. A crash loses a turn, and a long run does not create thousands of
/// shards per point.
/// @param elapsed time since the start of the run, s
/// @param points number of design points that take turns
inline double turn_seconds(double elapsed, std::int64_t points, int threads) {
  constexpr double of_all_points = 0.2;
  constexpr double shortest_of_all = 0.5, longest = 20.0;
  const double shortest = std::clamp(elapsed, shortest_of_all, std::max(shortest_of_all, 4.0 / threads));
  const double one = of_all_points * elapsed / static_cast<double>(std::max<std::int64_t>(points, 2));
  return std::clamp(one, shortest, longest);
}

/// Clock that tells when the turn of a design point should end, so that the trials of another point run.
class TurnClock {
 public:
  /// @param points number of design points that take turns
  /// @param threads number of threads that run trials
  TurnClock(std::int64_t points, int threads) : points_(points), threads_(threads) {}

  void begin_turn() { turn_begun_ = Clock::now(); }

  /// Time since the turn began, as a proportion of turn_seconds(). Above 1 the turn is over.
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

/// Maximum number of trials of a block, in a run of `rows` trials in all.
std::int64_t max_block_rows(const study::Study& study, std::int64_t rows, int threads);

/// Maximum memory that the traces of a block's retained trials take, bytes.
double max_block_traces(const study::Study& study);

/// Consecutive rows (trials) that one thread runs in one go.
struct Block {
  layout::RowRange rows;
  bool begins_turn{false};
};

/// Divides the rows (trials) of all design points' turns into blocks, which one thread each runs in one go. A
/// block ends with a chunk of the results file, and has fewer trials where many of them are retained with
/// their traces. The last blocks become smaller, so that the threads end together. Slow trials make small
/// blocks: the first ones are small, and the later ones have at most as many trials as took a second. The
/// data of the trials do not depend on their blocks.
class BlockSource {
 public:
  /// @param study must outlive this object
  /// @param ranges ranges of rows (numbers of the trials) to run, ascending and without overlaps
  BlockSource(const study::Study& study, std::span<const layout::RowRange> ranges, int threads);

  /// The next block of trials to run; nothing after the last one.
  std::optional<Block> next();

  /// Tells how long a block took, which limits the size of later blocks. Any thread may call it. The time of
  /// slow trials is forgotten step by step, because slow and fast design points may alternate.
  /// @param trials number of trials of the block
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
  std::int64_t max_rows_;  ///< Maximum number of trials of a block, by memory, samples and threads.
  /// Maximum number of trials of a block until it is known how long a trial takes.
  std::int64_t max_first_rows_;
  /// Mean time that one thread took per trial, s: that of the block which ended last, but at least half of
  /// the value before. 0: no block has ended.
  std::atomic<double> trial_seconds_{0.0};
  int threads_;
  std::int64_t remaining_;  ///< Number of rows (trials) that no block has got yet.
  double trace_bytes_;      ///< Memory that the trace (all samples) of one retained trial takes, bytes.
};

}  // namespace zerocount::trials
