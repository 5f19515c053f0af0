#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/undecided_moves.hpp"
#include "core/trial/outcome.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::comparison {

/// The trials of one design point, counted by one goal.
struct GoalTrials {
  study::Goal goal{};
  measures::CountedGoal counted{};
  std::int64_t machines{0};  ///< Number of machines, even if worlds take their place; 0: none.
  /// Counts of moves by machine; without machines, by world (a draw of what all machines share).
  measures::CellCounts counts{};
  std::vector<double> moves_in_goal{};  ///< [trial] number of moves that meet the goal

  /// Number of moves of a trial that the goal judges. @param moves number of moves of a trial
  std::int64_t asked_moves(std::int64_t moves) const { return measures::asked_moves(counted, moves); }
  /// Key of the goal's settling times in PointTrials::values: "goal_settling_time",
  /// "goal_settling_time[large]".
  std::string settling_time() const { return name_of_goal_measure("goal_settling_time", goal.name); }
};

/// The values of trials that are read in addition to the gate measures.
struct AlsoRead {
  std::vector<GateMeasure> bands{};    ///< Measures of error bands and tolerances that the file has.
  std::vector<GoalTrials> required{};  ///< Counts by the goals that a requirement asks for.
  std::vector<GoalTrials> judged{};    ///< Counts by the goals whose measures are judged.
  std::size_t claims{1};  ///< Claims on a design point that must all be met: goals times settings.
  /// Number of machines, or of worlds in their place. Trial i is on machine i mod machines. 0: no trials
  /// share a machine.
  std::int64_t machines{0};
};

/// The compared values of the trials of one design point.
struct PointTrials : AlsoRead {
  std::int64_t trials{0};
  std::int64_t moves{0};  ///< Number of moves of each trial.
  /// [name of the gate measure] the values. Qualities (1 or 0) and sums: [trial]. Other measures:
  /// [trial][move], flattened; NaN if a move has no value. goal_settling_time: infinite if the error does not
  /// settle.
  std::map<std::string, std::vector<double>, std::less<>> values{};
  measures::UndecidedMoves undecided{};  ///< Undecided moves among all moves.
  const layout::MeasureTable* table{&layout::measure_table()};

  const std::vector<double>& of(const GateMeasure& measure) const {
    return values.find(measure.name)->second;
  }
};

/// The compared values of trials. @param outcomes outcomes of all moves of the trials, [trial][move],
/// flattened
/// @param moves number of moves of each trial
PointTrials gather_trials(std::span<const trial::MoveOutcome> outcomes, std::int64_t moves,
                          const AlsoRead& also = {},
                          const layout::MeasureTable& table = layout::measure_table());

/// The compared values of the first `trials` trials of a design point of a complete study.
/// @throws Failure (bad_data) if the file is damaged.
PointTrials read_point_trials(const reading::AllTrialsFile& file, std::int64_t point, std::int64_t trials,
                              const AlsoRead& also = {});

/// A copy with only the first `trials` trials. `undecided`, `required` and GoalTrials::counts of `judged`
/// stay those of all trials.
PointTrials first_trials(const PointTrials& all, std::int64_t trials);

/// [trial] mean over the moves with a value; NaN if no move has a value. For arrival_time this is the mean
/// arrival time of the moves, not the settling time of the trial (worst_of_moves()).
std::vector<double> values_of_trials(const PointTrials& trials, const GateMeasure& measure);

/// [machine] mean over the trials of the machine, ignoring NaN; NaN for a machine without a value. Without
/// machines: the unchanged values.
/// @param values [trial]
std::vector<double> means_of_units(std::span<const double> values, std::int64_t machines);

/// [trial] worst value of the moves; infinitely bad if a move has no value. For arrival_time this is the
/// settling time of the trial.
std::vector<double> worst_of_moves(const PointTrials& trials, const GateMeasure& measure);

}  // namespace zerocount::comparison
