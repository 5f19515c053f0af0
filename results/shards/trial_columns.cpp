#include "results/shards/trial_columns.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "experiments/study/study.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::shards {
namespace {

/// The bytes of a column that holds one number of each trial.
/// @param value_of gives the number of a trial's result.
template <class ValueOf>
std::vector<std::byte> column_of(std::span<const TrialResult> results, const ValueOf& value_of) {
  using Value = std::invoke_result_t<ValueOf, const TrialResult&>;
  std::vector<std::byte> column(results.size() * sizeof(Value));
  std::byte* to = column.data();
  for (const TrialResult& result : results) {
    const Value value = value_of(result);
    std::memcpy(to, &value, sizeof value);
    to += sizeof value;
  }
  return column;
}

TableColumns trial_columns(const study::Study& study, std::span<const TrialResult> results) {
  TableColumns trials{std::ssize(results), {}};
  trials.columns.push_back(
      column_of(results, [&](const TrialResult& result) { return result.row / study.trials; }));
  trials.columns.push_back(
      column_of(results, [&](const TrialResult& result) { return result.row % study.trials; }));
  for (std::size_t input = 0; input < study.columns.inputs.size(); ++input)
    trials.columns.push_back(
        column_of(results, [input](const TrialResult& result) { return result.inputs[input]; }));
  return trials;
}

/// Makes the columns of a table from records.
/// @param width number of records in one row of the table.
template <class Record>
TableColumns record_columns(const std::vector<layout::RecordField<Record>>& fields,
                            const std::vector<const Record*>& records, std::int64_t width) {
  return {std::ssize(records) / width, layout::columns_of(fields, std::span(records))};
}

std::vector<const trial::MoveOutcome*> move_outcomes(std::span<const TrialResult> results) {
  std::vector<const trial::MoveOutcome*> moves;
  if (!results.empty()) moves.reserve(results.size() * results.front().outcome.moves.size());
  for (const TrialResult& result : results)
    for (const trial::MoveOutcome& move : result.outcome.moves) moves.push_back(&move);
  return moves;
}

/// Pointers to the measures of all error bands of the moves, [move][band], flattened.
std::vector<const trial::BandOutcome*> band_outcomes(std::span<const trial::MoveOutcome* const> moves,
                                                     const trial::ErrorBands& bands) {
  std::vector<const trial::BandOutcome*> outcomes;
  outcomes.reserve(moves.size() * bands.count);
  for (const trial::MoveOutcome* move : moves)
    for (std::size_t band = 0; band < bands.count; ++band) outcomes.push_back(&move->bands[band]);
  return outcomes;
}

/// The settling times of the moves for all tolerances, [move][tolerance], flattened.
std::vector<layout::ToleranceRecord> tolerance_records(std::span<const trial::MoveOutcome* const> moves,
                                                       const trial::Tolerances& tolerances) {
  std::vector<layout::ToleranceRecord> records;
  records.reserve(moves.size() * tolerances.count);
  for (const trial::MoveOutcome* move : moves)
    for (std::size_t i = 0; i < tolerances.count; ++i)
      records.push_back({move->tolerance_settling_times[i], move->other_tolerance_settling_times[i]});
  return records;
}

std::vector<layout::JerkRecord> jerk_records(std::span<const TrialResult> results) {
  std::vector<layout::JerkRecord> jerks;
  for (const TrialResult& result : results) {
    for (const trial::Jerk& jerk : result.jerks) jerks.push_back({jerk, result.row});
  }
  return jerks;
}

std::vector<layout::TraceRecord> trace_records(std::span<const TrialResult> results) {
  std::vector<layout::TraceRecord> records;
  for (const TrialResult& result : results) {
    for (const trial::SampleRecord& record : result.trace) records.push_back({record, result.row});
  }
  return records;
}

/// Appends the bytes of `part` to `whole`, and frees the memory of `part`.
void append(std::vector<std::byte>& whole, std::vector<std::byte>& part) {
  whole.insert(whole.end(), part.begin(), part.end());
  part = {};
}

}  // namespace

std::vector<ShardTable> shard_tables(const study::Study& study, const layout::MeasureTable& measures) {
  const study::StudyFeatures& features = study.features;
  std::vector<ShardTable> tables{{layout::trial_table(study.columns.inputs)},
                                 {layout::outcome_table(features, measures), study.moves},
                                 {layout::band_table(features.bands), study.moves}};
  if (features.tolerances.count > 0) tables.push_back({layout::tolerance_table(features), study.moves});
  tables.push_back({layout::jerk_table()});
  if (!study.retained_trials.empty()) tables.push_back({layout::trace_table(features)});
  return tables;
}

TrialColumns columns_of(const study::Study& study, const layout::MeasureTable& measures,
                        std::span<const TrialResult> results) {
  const study::StudyFeatures& features = study.features;
  const std::vector<const trial::MoveOutcome*> moves = move_outcomes(results);
  TrialColumns all;
  for (const TrialResult& result : results) all.rows.push_back(result.row);
  all.tables.push_back(trial_columns(study, results));
  all.tables.push_back(record_columns(layout::move_fields(features, measures), moves, study.moves));
  all.tables.push_back(record_columns(layout::band_fields(), band_outcomes(moves, features.bands),
                                      study.moves * static_cast<std::int64_t>(features.bands.count)));
  if (features.tolerances.count > 0) {
    const auto records = tolerance_records(moves, features.tolerances);
    all.tables.push_back(record_columns(layout::tolerance_fields(features), layout::pointers_to(records),
                                        study.moves * static_cast<std::int64_t>(features.tolerances.count)));
  }
  const std::vector<layout::JerkRecord> jerks = jerk_records(results);
  all.tables.push_back(record_columns(layout::jerk_fields(), layout::pointers_to(jerks), 1));
  if (!study.retained_trials.empty()) {
    const std::vector<layout::TraceRecord> trace = trace_records(results);
    all.tables.push_back(record_columns(layout::trace_fields(features), layout::pointers_to(trace), 1));
  }
  return all;
}

std::size_t bytes_of(const TrialColumns& columns) {
  std::size_t bytes = columns.rows.size() * sizeof(std::int64_t);
  for (const TableColumns& table : columns.tables)
    for (const std::vector<std::byte>& column : table.columns) bytes += column.size();
  return bytes;
}

TrialColumns joined(std::span<TrialColumns> parts) {
  if (parts.empty()) return {};
  TrialColumns all = std::move(parts.front());
  const std::span<TrialColumns> others = parts.subspan(1);
  for (const TrialColumns& part : others) all.rows.insert(all.rows.end(), part.rows.begin(), part.rows.end());
  for (std::size_t i = 0; i < all.tables.size(); ++i) {
    for (const TrialColumns& part : others) all.tables[i].rows += part.tables[i].rows;
    // Column by column: only one of them is in memory twice.
    for (std::size_t column = 0; column < all.tables[i].columns.size(); ++column) {
      std::vector<std::byte>& whole = all.tables[i].columns[column];
      std::size_t size = whole.size();
      for (const TrialColumns& part : others) size += part.tables[i].columns[column].size();
      whole.reserve(size);
      for (TrialColumns& part : others) append(whole, part.tables[i].columns[column]);
    }
  }
  return all;
}

}  // namespace zerocount::shards
