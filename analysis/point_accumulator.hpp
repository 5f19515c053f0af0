#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/point_statistics.hpp"
#include "analysis/tally.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount {

/// Takes the trials of one design point, one after the other, and gives its statistics.
///
/// Its memory grows with the number of distinct settling times, jerk counts and jerk intervals, not with the
/// number of trials: for one sample rate, at most with the samples of a move.
class PointAccumulator {
 public:
  /// Adds a trial with its jerks in order of move and onset.
  /// @throws Failure (bad_data) where the trial has no move or another number of moves than those before it,
  /// or its jerks are out of order or not those that its outcome counts.
  void add(const TrialOutcome& trial, std::span<const Jerk> jerks);

  /// The statistics of the trials added so far.
  PointSummary statistics() const;

 private:
  void add_moves(const TrialOutcome& trial);
  void add_jerks(const MoveOutcome& move, std::span<const Jerk> jerks);

  PointSummary counted_;  ///< the fields that are plain counts and moments
  Tally<double> settling_times_;
  Tally<std::int64_t> jerk_counts_;
  Tally<double> jerk_intervals_;
  RankTrend interval_trend_;
  std::int64_t one_count_jerks_{0};
  std::vector<double> intervals_;  ///< of the move at hand; kept for its memory
};

}  // namespace zerocount
