#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "runners/trials/turns.hpp"

namespace zerocount::trials {

/// Number of trials of a block at most, in a run of `rows` trials.
std::int64_t max_block_rows(const study::Study& study, std::int64_t rows, int threads);

/// Memory of the traces of a block at most, bytes.
double max_block_traces(const study::Study& study);

/// Rows that one thread runs.
struct Block {
  layout::RowRange rows;
  bool begins_turn{false};
};

/// Divides the rows of all turns into blocks. A block ends with a chunk of the results file, and has fewer
/// trials where many of them are retained with their traces. The last blocks become smaller, so that the
/// threads end together.
class BlockSource {
 public:
  /// @param study stays as long as this @param ranges as for Turns
  BlockSource(const study::Study& study, std::span<const layout::RowRange> ranges, int threads);

  /// The next block; none behind the last one.
  std::optional<Block> next();

 private:
  std::int64_t next_row() const { return turns_.upcoming(1).first; }
  double end_of_turn() const;
  layout::RowRange with_few_traces(layout::RowRange rows) const;

  const study::Study& study_;
  Turns turns_;
  TurnClock clock_;
  std::int64_t max_rows_;  ///< of a block
  int threads_;
  std::int64_t remaining_;  ///< rows
  double trace_bytes_;      ///< of one retained trial
};

}  // namespace zerocount::trials
