#include "runners/study_run/extension.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

namespace zerocount::study_run {
namespace {

constexpr std::int64_t max_moves_at_once = 1 << 16;
constexpr std::int64_t records_at_once = 1 << 16;

/// Positions of the retained trials' records in the file, by row.
std::map<std::int64_t, layout::RowRange> places_of_records(const reading::StudyFile& file) {
  std::map<std::int64_t, layout::RowRange> places;
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

/// Reads the trials `rows` of the file, renumbered to their rows in the study.
std::vector<shards::TrialResult> read_trials(const reading::StudyFile& file, layout::RowRange rows,
                                             std::int64_t first_row,
                                             const std::map<std::int64_t, layout::RowRange>& records) {
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

}  // namespace

std::vector<shards::ShardInfo> copy_trials(const reading::StudyFile& file, const study::Study& study,
                                           const std::filesystem::path& directory,
                                           std::span<const layout::RowRange> missing) {
  const std::map<std::int64_t, layout::RowRange> records = places_of_records(file);
  const std::int64_t trials = file.header().trials;
  const std::int64_t at_once = std::max<std::int64_t>(max_moves_at_once / study.moves, 1);
  std::vector<shards::ShardInfo> written;
  for (const layout::RowRange& range : missing) {
    for (std::int64_t row = range.first; row < range.end();) {
      const std::int64_t point = row / study.trials;
      const std::int64_t index = row % study.trials;
      const std::int64_t count = std::min({trials - index, range.end() - row, at_once});
      if (count <= 0) {  // beyond the file's trials of this point
        row = (point + 1) * study.trials;
        continue;
      }
      written.push_back({shards::shard_path(directory, {row, count}), {row, count}});
      shards::write_shard(written.back().path, study, row,
                          read_trials(file, {point * trials + index, count}, row, records),
                          file.header().provenance);
      row += count;
    }
  }
  return written;
}

}  // namespace zerocount::study_run
