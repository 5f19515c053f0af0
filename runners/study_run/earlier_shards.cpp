#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/file_run.hpp"

namespace zerocount::study_run {
namespace {

namespace fs = std::filesystem;

/// Checks that a shard of this study was run with the controller of this study. Does nothing for shards of
/// other studies or formats.
/// @throws ForeignFile for a shard of this study that was run with another controller.
void require_same_plugin(const fs::path& shard, const study::Study& study) {
  std::optional<layout::FileHeader> header;
  try {
    header = shards::inspect_header(shard);
    if (!layout::study_differences(shard, *header, study).empty()) return;
  } catch (const Failure&) {
    return;  // another format
  }
  layout::require_same_plugin(shard, *header, study.plugin.get());
}

}  // namespace

EarlierShards choose_shards(const std::vector<shards::ShardInfo>& sound, layout::RowRange wanted) {
  EarlierShards shards;
  std::int64_t covered = wanted.first;
  for (const shards::ShardInfo& shard : sound) {
    shards.all.push_back(shard.path);
    if (shard.rows.first < covered || shard.rows.end() > wanted.end()) continue;
    covered = shard.rows.end();
    shards.usable.push_back(shard);
  }
  return shards;
}

EarlierShards earlier_shards(const fs::path& directory, const study::Study& study, layout::RowRange wanted,
                             ForeignShards foreign) {
  const shards::ShardSurvey survey = shards::list_shards(directory, study);
  for (const shards::ShardProblem& bad : survey.problems) {
    if (bad.kind == shards::ShardProblem::Kind::foreign && foreign == ForeignShards::remove) {
      std::error_code ignored;
      fs::remove(bad.path, ignored);
      continue;
    }
    if (bad.kind == shards::ShardProblem::Kind::foreign) {
      require_same_plugin(bad.path, study);
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: holds trials of another run, which this one must not touch ({}); finish that run "
                      "first, give another name with -o, or remove it with --force",
                      directory.string(), bad.problem));
    }
    fs::path aside = bad.path;
    aside += damaged_extension;
    std::error_code error;
    fs::rename(bad.path, aside, error);
    status::tell("warning: {}; its trials are run again{}\n", bad.problem,
                 error ? "" : fmt::format(", and the file is kept as {}", aside.filename().string()));
  }
  shards::remove_unfinished(survey);
  return choose_shards(survey.shards, wanted);
}

void remove_shards(const fs::path& directory, const std::vector<fs::path>& shards) {
  std::error_code error;
  for (const fs::path& shard : shards) fs::remove(shard, error);
  fs::remove(directory, error);
}

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
