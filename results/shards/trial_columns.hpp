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

/// The data of one finished trial that a file keeps.
struct TrialResult {
  std::int64_t row{0};  ///< Global row of the trial, point·trials + index
  /// Values of the input parameters of the trial, [input column of the study], in the unit of the column
  std::vector<double> inputs;
  trial::TrialOutcome outcome;             ///< Measures of the trial, with one entry per move
  std::vector<trial::Jerk> jerks;          ///< Jerks (excursions of the error from zero after arrival),
                                           ///< ordered by move and onset
  std::vector<trial::SampleRecord> trace;  ///< All samples of a trial whose samples are kept; otherwise empty
};

/// Description of a table with rows of trials in a shard.
struct ShardTable {
  layout::Table table;
  std::int64_t second{1};  ///< Size of the table's second dimension; 1 if it has none
};

/// Descriptions of the tables of trials in a shard of the study, in the order of the file.
std::vector<ShardTable> shard_tables(const study::Study& study, const layout::MeasureTable& measures);

/// Some rows of a table, as the bytes of the elements of its columns.
struct TableColumns {
  std::int64_t rows{0};
  std::vector<std::vector<std::byte>> columns;  ///< Bytes of the elements of each column, [column]
};

/// Data of finished trials as the columns that a shard stores. They take a fifth of the memory of the
/// TrialResults.
struct TrialColumns {
  std::vector<std::int64_t> rows;    ///< Global row of each trial
  std::vector<TableColumns> tables;  ///< Rows of the tables, in the order of shard_tables()
};

TrialColumns columns_of(const study::Study& study, const layout::MeasureTable& measures,
                        std::span<const TrialResult> results);

/// Memory of the columns' elements, bytes.
std::size_t bytes_of(const TrialColumns& columns);

/// Appends the columns of all parts to one another, in their order. The parts are empty afterwards.
TrialColumns joined(std::span<TrialColumns> parts);

}  // namespace zerocount::shards
