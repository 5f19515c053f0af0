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

/// The trials of one design point as a goal counts them.
struct GoalTrials {
  study::Goal goal{};
  measures::CountedGoal counted{};
  std::int64_t machines{0};             ///< number of machines, also of a study with worlds; 0: none
  measures::CellCounts counts{};        ///< of the shape that tells machines and worlds apart
  std::vector<double> moves_in_goal{};  ///< [trial]

  /// Number of moves of a trial that it is about. @param moves of a trial
  std::int64_t asked_moves(std::int64_t moves) const { return measures::asked_moves(counted, moves); }
  /// The name of its times among the values of trials: "goal_settling_time", "goal_settling_time[large]".
  std::string settling_time() const { return name_of_goal_measure("goal_settling_time", goal.name); }
};

/// The values of trials that are read beside the gate measures.
struct AlsoRead {
  std::vector<GateMeasure> bands{};    ///< measures of error bands, which the file has
  std::vector<GoalTrials> required{};  ///< by the goals that a requirement asks for
  std::vector<GoalTrials> judged{};    ///< by the goals whose measures are judged
  std::size_t claims{1};  ///< on a design point: goals times conditions, all of which must be met
  std::int64_t machines{
      0};  ///< number of machines, or of worlds: trial i on machine i mod machines; 0: no trials share one
};

/// The compared values of the trials of one design point.
struct PointTrials : AlsoRead {
  std::int64_t trials{0};
  std::int64_t moves{0};  ///< of each
  /// [name of the gate measure] of qualities, as 1 or 0, and of sums: [trial]; of other measures:
  /// [trial][move], flattened, NaN where a move has no value; of goal_settling_time infinity where the error
  /// does not settle.
  std::map<std::string, std::vector<double>, std::less<>> values{};
  measures::UndecidedMoves undecided{};  ///< of all moves
  const layout::MeasureTable* table{&layout::measure_table()};

  const std::vector<double>& of(const GateMeasure& measure) const {
    return values.find(measure.name)->second;
  }
};

/// From the outcomes of all moves of the trials, [trial][move], flattened.
/// @param moves of each trial
PointTrials gather_trials(std::span<const trial::MoveOutcome> outcomes, std::int64_t moves,
                          const AlsoRead& also = {},
                          const layout::MeasureTable& table = layout::measure_table());

/// The first `trials` trials of design point `point` of a whole study.
/// @throws Failure (bad_data) where the file is damaged.
PointTrials read_point_trials(const reading::AllTrialsFile& file, std::int64_t point, std::int64_t trials,
                              const AlsoRead& also = {});

/// The first `trials` of them. `undecided` stays that of all.
PointTrials first_trials(const PointTrials& all, std::int64_t trials);

/// For each trial the mean over its moves with a value; NaN where none has. For arrival_time this is the
/// mean settling time of the moves, not the settling time of the trial (worst_of_moves()).
std::vector<double> values_of_trials(const PointTrials& trials, const GateMeasure& measure);

/// Mean over the trials of each machine, ignoring NaN; NaN for a machine without a value. Without machines
/// the values themselves.
/// @param values [trial]
std::vector<double> means_of_units(std::span<const double> values, std::int64_t machines);

/// The worst value of the moves of each trial, [trial]; infinitely bad if a move has no value. For
/// arrival_time this is the settling time of the trial.
std::vector<double> worst_of_moves(const PointTrials& trials, const GateMeasure& measure);

}  // namespace zerocount::comparison
