#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/measures/undecided_moves.hpp"
#include "core/trial/outcome.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::comparison {

/// What a comparison looks at of the trials of one design point.
struct PointTrials {
  std::int64_t trials{0};
  std::int64_t moves{0};  ///< of each
  /// [name of the gate measure] of qualities, as 1 or 0, and of sums: [trial]; of other measures:
  /// [trial][move], flattened, NaN where a move has no value.
  std::map<std::string, std::vector<double>, std::less<>> values{};
  measures::UndecidedMoves undecided{};  ///< of all moves
  std::int64_t rigs{0};  ///< that the trials run on, trial i on rig i mod rigs; 0: no trials share a rig
  const layout::MeasureTable* table{&layout::measure_table()};

  const std::vector<double>& of(const GateMeasure& measure) const {
    return values.find(measure.name)->second;
  }
};

/// From the outcomes of all moves of the trials, [trial][move], flattened.
/// @param moves of each trial
PointTrials gather_trials(std::span<const trial::MoveOutcome> outcomes, std::int64_t moves,
                          const layout::MeasureTable& table = layout::measure_table());

/// The trials of design point `point` of a whole study, with `rigs` 0: a file does not say it by itself.
/// @throws Failure (bad_data) where the file is damaged.
PointTrials read_point_trials(const reading::StudyFile& file, std::int64_t point);

/// The first `trials` of them. `undecided` stays that of all.
PointTrials first_trials(const PointTrials& all, std::int64_t trials);

/// The value of every trial with one, over those of its moves that have one: their mean; with rigs, the mean
/// of these of every rig with one.
std::vector<double> trial_means(const PointTrials& trials, const GateMeasure& measure);

/// Mean over the trials of every rig, of those values that are not NaN; rigs without a value are left out.
/// Without rigs the values themselves, without NaN.
/// @param values [trial]
std::vector<double> means_by_rig(std::span<const double> values, std::int64_t rigs);

/// The largest value of the moves of every trial, [trial]; infinite where a move has none.
std::vector<double> largest_of_moves(const PointTrials& trials, const GateMeasure& measure);

}  // namespace zerocount::comparison
