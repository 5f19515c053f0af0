#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/trial/outcome.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::measures {

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
