#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/measures/undecided_moves.hpp"
#include "core/trial/outcome.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount {

/// What a comparison looks at of the trials of one design point.
struct PointTrials {
  std::int64_t trials{0};
  std::int64_t moves{0};              ///< of each
  std::vector<bool> zero_count;       ///< [trial] every move ended in zero counts
  std::vector<bool> arrived;          ///< [trial] every move arrived
  std::vector<bool> stable;           ///< [trial] every move was stable
  std::vector<double> settling_time;  ///< [trial][move], flattened, s; NaN where it did not arrive
  std::vector<double> jerks;          ///< [trial] of all moves
  UndecidedMoves undecided;           ///< of all moves
  std::int64_t rigs{0};  ///< that the trials run on, trial i on rig i mod rigs; 0: no trials share a rig
};

/// From the outcomes of all moves of the trials, [trial][move], flattened.
/// @param moves of each trial
PointTrials gather_trials(std::span<const MoveOutcome> outcomes, std::int64_t moves);

/// The trials of design point `point` of a whole study, with `rigs` 0: a file does not say it by itself.
/// @throws Failure (bad_data) where the file is damaged.
PointTrials read_point_trials(const StudyFile& file, std::int64_t point);

/// The first `trials` of them. `undecided` stays that of all.
PointTrials first_trials(const PointTrials& all, std::int64_t trials);

/// Whether the trials have the quality of a proportion, [trial].
const std::vector<bool>& qualities(const PointTrials& trials, GateQuantity proportion);

/// Mean settling time of every trial with a move that arrived, over those moves, s; with rigs, the mean of
/// these of every rig with one.
std::vector<double> settling_times(const PointTrials& trials);

/// Mean over the trials of every rig, of those values that are not NaN; rigs without a value are left out.
/// Without rigs the values themselves, without NaN.
/// @param values [trial]
std::vector<double> means_by_rig(std::span<const double> values, std::int64_t rigs);

/// Settling time of the slowest move of every trial, [trial], s; infinite where one did not arrive.
std::vector<double> slowest_settling_times(const PointTrials& trials);

}  // namespace zerocount
