#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/trial/outcome.hpp"
#include "results/layout/measure_table.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::measures {

/// The value of a move for the statistics; NaN if it has none.
double counted_value(const layout::Measure& measure, const trial::MoveOutcome& move);

/// Whether the moves have targets where the measure needs them.
bool has_targets(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves);

/// The value of a trial, combined from the values of its moves by Measure::of_trial; 1 or 0 for a quality.
/// The settling time of a trial is that of its slowest move.
/// @param late the value of a time that was not reached; without it the value of the trial is NaN.
double value_of_trial(const layout::Measure& measure, std::span<const trial::MoveOutcome> moves,
                      const std::function<double()>& late = {});

/// Calls visit(row, moves) for the trials of these global rows in order, reading the file in blocks. `moves`
/// is a span of the outcomes of the trial's moves.
template <class Visit>
void visit_trials(const reading::StudyFile& file, layout::RowRange rows, const Visit& visit) {
  const std::int64_t moves = file.moves();
  const std::int64_t at_once = layout::chunk_rows(moves);
  for (std::int64_t first = rows.first; first < rows.end(); first += at_once) {
    const layout::RowRange block{first, std::min(at_once, rows.end() - first)};
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes(block);
    for (std::int64_t row = block.first; row < block.end(); ++row) {
      visit(row, std::span(outcomes).subspan(static_cast<std::size_t>((row - block.first) * moves),
                                             static_cast<std::size_t>(moves)));
    }
  }
}

}  // namespace zerocount::measures
