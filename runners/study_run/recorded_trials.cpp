#include "runners/study_run/recorded_trials.hpp"

#include <algorithm>
#include <cstddef>

namespace zerocount::study_run {
namespace {

constexpr std::int64_t records_at_once = 1 << 16;

}  // namespace

RecordPlaces places_of_records(const reading::StudyFile& file) {
  RecordPlaces places;
  for (std::int64_t first = 0; first < file.trace_count(); first += records_at_once) {
    const std::int64_t count = std::min(records_at_once, file.trace_count() - first);
    std::int64_t position = first;
    for (const layout::TraceRecord& record : file.trace_at(first, count)) {
      ++places.try_emplace(record.trial, layout::RowRange{position, 0}).first->second.count;
      ++position;
    }
  }
  return places;
}

std::vector<shards::TrialResult> read_trials(const reading::StudyFile& file, layout::RowRange rows,
                                             std::int64_t first_row, const RecordPlaces& records) {
  std::vector<shards::TrialResult> results(static_cast<std::size_t>(rows.count));
  for (std::size_t column = 0; column < file.input_columns().size(); ++column) {
    const std::vector<double> values = file.input(column, rows);
    for (std::size_t i = 0; i < results.size(); ++i) results[i].inputs.push_back(values[i]);
  }
  const std::vector<trial::MoveOutcome> outcomes = file.outcomes(rows);
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].row = first_row + static_cast<std::int64_t>(i);
    const auto begin = outcomes.begin() + static_cast<std::ptrdiff_t>(i) * file.moves();
    results[i].outcome.moves.assign(begin, begin + file.moves());
    const auto place = records.find(rows.first + static_cast<std::int64_t>(i));
    if (place == records.end()) continue;
    for (const layout::TraceRecord& record : file.trace_at(place->second.first, place->second.count))
      results[i].trace.push_back(record);
  }
  for (const layout::JerkRecord& jerk : file.jerks(rows))
    results[static_cast<std::size_t>(jerk.trial - rows.first)].jerks.push_back(jerk);
  return results;
}

}  // namespace zerocount::study_run
