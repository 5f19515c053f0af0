#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/undecided_moves.hpp"
#include "core/trial/outcome.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::comparison {

/// One goal with the counts of the moves that meet it, for the trials of one design point.
struct GoalTrials {
  study::Goal goal{};
  measures::MoveCriterion criterion{};
  /// Number of machines, also if worlds take their place as independent units; 0: the study has no machines.
  std::int64_t machines{0};
  /// Counts of moves by machine; without machines, by world (a draw of what all machines share).
  measures::CellCounts counts{};
  /// [trial] Number of moves that meet the goal, among those that it judges.
  std::vector<double> moves_in_goal{};

  /// Number of moves of a trial that the goal judges.
  /// @param moves number of moves of a trial
  std::int64_t asked_moves(std::int64_t moves) const { return measures::asked_moves(criterion, moves); }
  /// Key of the goal's settling times in PointTrials::values: "goal_settling_time", or with the goal's name
  /// "goal_settling_time[large]".
  std::string settling_time() const { return name_of_goal_measure("goal_settling_time", goal.name); }
};

/// Data of the trials that are read in addition to the values of the gate measures.
struct AlsoRead {
  /// Measures of error bands and tolerances that requirements name and the file has.
  std::vector<GateMeasure> bands{};
  /// Goals that a requirement names, with the counts of the moves that meet them.
  std::vector<GoalTrials> required{};
  /// Goals whose measures are judged, with the counts of the moves that meet them.
  std::vector<GoalTrials> judged{};
  /// Number of claims on a design point that must all be met: number of goals times number of settings.
  std::size_t claims{1};
  /// Number of clusters of dependent trials: machines, or worlds in their place. Trial i belongs to cluster i
  /// mod `machines`. 0: all trials are independent.
  std::int64_t machines{0};
};

/// The compared values of the trials of one design point.
struct PointTrials : AlsoRead {
  std::int64_t trials{0};
  std::int64_t moves{0};  ///< Number of moves of each trial.
  /// {name of a gate measure: its values}. Qualities (1 or 0) and sums: one per trial. Other measures:
  /// [trial][move], flattened; NaN if a move has no value. goal_settling_time: infinite if the error does not
  /// settle.
  std::map<std::string, std::vector<double>, std::less<>> values{};
  /// Counts of the moves that ended off target and are undecided: neither stable nor shown unstable.
  measures::UndecidedMoves undecided{};
  const layout::MeasureTable* table{&layout::measure_table()};

  const std::vector<double>& of(const GateMeasure& measure) const {
    return values.find(measure.name)->second;
  }
};

/// The compared values of trials that are in memory.
/// @param outcomes outcomes of all moves of the trials, [trial][move], flattened
/// @param moves number of moves of each trial
PointTrials gather_trials(std::span<const trial::MoveOutcome> outcomes, std::int64_t moves,
                          const AlsoRead& also = {},
                          const layout::MeasureTable& table = layout::measure_table());

/// The compared values of the first `trials` trials of a design point of a complete study.
/// @throws Failure (bad_data) if the file is damaged.
PointTrials read_point_trials(const reading::AllTrialsFile& file, std::int64_t point, std::int64_t trials,
                              const AlsoRead& also = {});

/// A copy with only the first `trials` trials. `undecided`, `required` and GoalTrials::counts of `judged`
/// still refer to all trials.
PointTrials first_trials(const PointTrials& all, std::int64_t trials);

/// [trial] Mean over those moves of the trial that have a value; NaN if no move has one. For arrival_time
/// this is the mean arrival time of the moves, not the settling time of the trial (worst_of_moves()).
std::vector<double> values_of_trials(const PointTrials& trials, const GateMeasure& measure);

/// [machine] mean over the trials of the machine, ignoring NaN; NaN for a machine without a value. Without
/// machines: the unchanged values.
/// @param values [trial]
std::vector<double> means_of_units(std::span<const double> values, std::int64_t machines);

/// [trial] Worst value among the moves of the trial; infinitely bad if a move has no value. For arrival_time
/// this is the settling time of the trial.
std::vector<double> worst_of_moves(const PointTrials& trials, const GateMeasure& measure);

}  // namespace zerocount::comparison
