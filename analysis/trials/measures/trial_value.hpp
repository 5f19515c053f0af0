#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/basis/statistics/unknown.hpp"
#include "core/trial/divergence.hpp"
#include "core/trial/outcome.hpp"
#include "results/layout/measure_table.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::measures {

/// The value of a move for the statistics of a measure; NaN if the move has none.
/// @param value value of the measure's member of MoveOutcome
inline double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move, double value) {
  const bool is_lost = measure.values.needs_motion && move.outcome == trial::Outcome::nonfinite;
  if (is_lost || !trial::was_run(move)) return statistics::unknown;
  return measure.values.magnitude ? std::abs(value) : value;
}
double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move);

/// The value of a measure for comparison with limits and for rankings: infinite, with the sign of the worse
/// direction, if the event never came; null if there is nothing to measure (layout::Missing).
/// @param value value of the measure's member of MoveOutcome
std::optional<double> ranked_value(const layout::CountedValues& values, double value);
/// The value of a measure of a move for comparison with limits and for rankings. If a value is missing
/// because the move was stopped or its motion was lost, it is infinite for any measure. A move that was not
/// run has only times, and these count as never reached.
std::optional<double> ranked_value(const layout::Measure& measure, const trial::MoveOutcome& move);

/// Whether the measure applies to these moves: they have targets, or the measure needs none.
bool has_targets(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves);

/// Number of moves of a trial that must have the quality so that the trial counts as having it.
std::int64_t wanted_moves(const layout::Measure& quality, std::int64_t moves_of_trial);

/// The value of a trial for a measure that is summed over its moves.
/// @param value function that returns the value of a move
template <class Moves, class Value = std::identity>
double sum_of_moves(const Moves& moves, const Value& value = {}) {
  double sum = 0.0;
  for (const auto& move : moves) sum += value(move);
  return sum;
}

/// The value of a measure for a trial, combined from the values of its moves by Measure::reduction; 1 or 0
/// for a quality. The settling time of a trial is that of its slowest move.
/// @param late function that returns the value for a time that was not reached; without it the trial's value
/// is NaN
double value_of_trial(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves,
                      const std::function<double()>& late = {});

/// The first part of these global rows (rows of trials over all design points): up to the end of the chunk of
/// the file's outcomes that holds the first row.
inline layout::RowRange rows_of_first_chunk(const reading::AllTrialsFile& file, layout::RowRange rows) {
  const std::int64_t chunk = layout::chunk_rows(file.moves());
  const std::int64_t in_chunk = (rows.first - file.rows().first) % chunk;
  return {rows.first, std::min(chunk - in_chunk, rows.count)};
}

/// Calls visit(block, outcomes) for successive blocks of trials, given by their global rows (over all design
/// points), in order. Each block ends at the end of a chunk of the file. `outcomes` is a span of the outcomes
/// of the block's moves, [trial][move].
template <class Visit>
void visit_blocks(const reading::AllTrialsFile& file, layout::RowRange rows, const Visit& visit) {
  for (layout::RowRange block; rows.count > 0; rows = {block.end(), rows.count - block.count}) {
    block = rows_of_first_chunk(file, rows);
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes(block);
    visit(block, std::span(outcomes));
  }
}

/// Calls visit(row, moves) for each trial of these global rows (over all design points) in order, reading the
/// file in blocks. `moves` is a span of the outcomes of the trial's moves.
template <class Visit>
void visit_trials(const reading::AllTrialsFile& file, layout::RowRange rows, const Visit& visit) {
  const auto moves = static_cast<std::size_t>(file.moves());
  visit_blocks(file, rows, [&](layout::RowRange block, std::span<const trial::MoveOutcome> rest) {
    for (std::int64_t row = block.first; row < block.end(); ++row, rest = rest.subspan(moves)) {
      visit(row, rest.first(moves));
    }
  });
}

}  // namespace zerocount::measures
