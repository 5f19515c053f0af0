#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "runners/study_run/file_run.hpp"

namespace zerocount::study_run {
namespace {

constexpr std::int64_t records_at_once = 1 << 16;

}  // namespace

RecordPlaces places_of_records(const reading::TrialTables& trials) {
  RecordPlaces places;
  for (std::int64_t first = 0; first < trials.trace_count(); first += records_at_once) {
    const std::int64_t count = std::min(records_at_once, trials.trace_count() - first);
    std::int64_t position = first;
    for (const layout::TraceRecord& record : trials.trace_at(first, count)) {
      ++places.try_emplace(record.trial, layout::RowRange{position, 0}).first->second.count;
      ++position;
    }
  }
  return places;
}

std::vector<shards::TrialResult> read_trials(const reading::TrialTables& trials, layout::RowRange rows,
                                             std::int64_t first_row, const RecordPlaces& records) {
  const layout::RowRange positions = trials.positions_of(rows);
  const std::vector<std::int64_t> stored_rows = trials.rows(positions);
  std::vector<shards::TrialResult> results(stored_rows.size());
  for (std::size_t column = 0; column < trials.input_columns().size(); ++column) {
    const std::vector<double> values = trials.input(column, positions);
    for (std::size_t i = 0; i < results.size(); ++i) results[i].inputs.push_back(values[i]);
  }
  const std::vector<trial::MoveOutcome> outcomes = trials.outcomes(positions);
  const std::vector<layout::JerkRecord> jerks = trials.jerks_of(rows);
  auto jerk = jerks.begin();
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].row = stored_rows[i] - rows.first + first_row;
    const auto begin = outcomes.begin() + static_cast<std::ptrdiff_t>(i) * trials.moves();
    results[i].outcome.moves.assign(begin, begin + trials.moves());
    for (; jerk != jerks.end() && jerk->trial <= stored_rows[i]; ++jerk)
      if (jerk->trial == stored_rows[i]) results[i].jerks.push_back(*jerk);
    const auto place = records.find(stored_rows[i]);
    if (place == records.end()) continue;
    for (const layout::TraceRecord& record : trials.trace_at(place->second.first, place->second.count))
      results[i].trace.push_back(record);
  }
  return results;
}

}  // namespace zerocount::study_run
