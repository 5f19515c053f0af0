#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/point_statistics.hpp"
#include "analysis/statistics_options.hpp"
#include "analysis/tally.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount {

/// What is known of the moves before they are looked at.
struct MoveKind {
  bool open_loop{false};         ///< they have torque levels, and no target
  bool final_error_known{true};  ///< false in results that do not hold it
};

/// Takes the trials of one design point, one after the other, and gives its statistics.
///
/// Its memory grows with the number of distinct settling times, jerk counts, jerk intervals and final errors,
/// not with the number of trials: for one sample rate, at most with the samples of a move and the counts that
/// the rotor strays.
class PointAccumulator {
 public:
  explicit PointAccumulator(MoveKind kind = {}) : kind_(kind) {}

  /// Adds a trial with its jerks in order of move and onset.
  /// @throws Failure (bad_data) where the trial has no move or another number of moves than those before it,
  /// its jerks are out of order or not those that its outcome counts, or its moves are not of the kind.
  void add(const TrialOutcome& trial, std::span<const Jerk> jerks);

  /// The statistics of the trials added so far.
  /// @throws Failure (bad_input) for a confidence outside (0, 1).
  PointSummary statistics(const StatisticsOptions& options = {}) const;

 private:
  void add_moves(const TrialOutcome& trial);
  void add_slowest(const std::vector<MoveOutcome>& moves);
  void add_measures(const MoveOutcome& move);
  void add_jerks(const MoveOutcome& move, std::span<const Jerk> jerks);

  MoveKind kind_;
  PointSummary counted_;  ///< the fields that are plain counts and moments
  Tally<double> settling_times_;
  Tally<double> slowest_times_;  ///< of the trials all of whose moves arrived: of the move that took longest
  Tally<std::int64_t> final_errors_;
  Tally<std::int64_t> jerk_counts_;
  Tally<double> jerk_intervals_;
  RankTrend interval_trend_;
  std::int64_t one_count_jerks_{0};
  std::vector<double> intervals_;  ///< of the move at hand; kept for its memory
};

}  // namespace zerocount
