#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "results/layout/row_range.hpp"

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

}  // namespace zerocount::trials
