#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::shards {

/// The stored data of one trial.
struct TrialResult {
  std::int64_t row{0};  ///< Global row, point·trials + index
  /// Inputs of the trial, [input column of the study], in the unit of the column
  std::vector<double> inputs;
  trial::TrialOutcome outcome;             ///< Outcome with one entry per move
  std::vector<trial::Jerk> jerks;          ///< Jerks, ordered by move and onset
  std::vector<trial::SampleRecord> trace;  ///< Every sample of a retained trial; otherwise empty
};

/// A table with rows of trials in a shard.
struct ShardTable {
  layout::Table table;
  std::int64_t second{1};  ///< Size of the second dimension
};

/// The tables of trials in a shard of the study, in the order of the file.
std::vector<ShardTable> shard_tables(const study::Study& study, const layout::MeasureTable& measures);

/// Rows of a table, as the bytes of the elements of its columns.
struct TableColumns {
  std::int64_t rows{0};
  std::vector<std::vector<std::byte>> columns;  ///< Bytes of each column, [column]
};

/// Trials in the columns that a shard stores. They take a fifth of the memory of the results.
struct TrialColumns {
  std::vector<std::int64_t> rows;    ///< Global row of each trial
  std::vector<TableColumns> tables;  ///< Tables in the order of shard_tables()
};

TrialColumns columns_of(const study::Study& study, const layout::MeasureTable& measures,
                        std::span<const TrialResult> results);

/// Size of the columns, bytes.
std::size_t bytes_of(const TrialColumns& columns);

/// The columns of all parts, in their order. Empties the parts.
TrialColumns joined(std::span<TrialColumns> parts);

}  // namespace zerocount::shards
