#include "results/shards/shard.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/input_validation.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::shards {
namespace {

namespace fs = std::filesystem;

void require_fit(const study::Study& study, layout::RowRange rows, std::span<const TrialResult> trials,
                 std::span<const layout::PointSums> sums) {
  const bool sparse = layout::has_sums(study.retention);
  const std::int64_t points = (rows.end() - 1) / study.trials - rows.first / study.trials + 1;
  if (rows.count < 1 || rows.first < 0 || rows.end() > study::trial_count(study) ||
      (!sparse && std::ssize(trials) != rows.count) || std::ssize(sums) != (sparse ? points : 0))
    throw std::invalid_argument("a shard needs trials of its study");
  std::int64_t next = rows.first;
  for (const TrialResult& trial : trials) {
    const bool fits = (sparse ? trial.row >= next && trial.row < rows.end() : trial.row == next) &&
                      trial.inputs.size() == study.columns.inputs.size() &&
                      std::ssize(trial.outcome.moves) == study.moves;
    if (!fits)
      throw std::invalid_argument(fmt::format("the result for row {} does not fit the study", trial.row));
    next = trial.row + 1;
  }
}

void write_row_numbers(layout::TableIo& io, std::span<const TrialResult> results) {
  std::vector<std::int64_t> rows(results.size());
  std::transform(results.begin(), results.end(), rows.begin(),
                 [](const TrialResult& one) { return one.row; });
  io.row_scale().write(0, std::ssize(rows), rows.data());
}

void write_trials(hdf5::File& file, const study::Study& study, std::span<const TrialResult> results,
                  hdf5::Compression compression) {
  const std::int64_t rows = std::ssize(results);
  layout::TableIo io =
      layout::TableIo::create(file, layout::trial_table(study.columns.inputs), rows, 1, compression);
  write_row_numbers(io, results);
  const auto write = [&](std::size_t column, const auto& value_of) {
    std::vector<std::invoke_result_t<decltype(value_of), const TrialResult&>> values(results.size());
    std::transform(results.begin(), results.end(), values.begin(), value_of);
    io.column(column).write(0, rows, values.data());
  };
  write(0, [&](const TrialResult& result) { return result.row / study.trials; });
  write(1, [&](const TrialResult& result) { return result.row % study.trials; });
  for (std::size_t input = 0; input < study.columns.inputs.size(); ++input)
    write(2 + input, [input](const TrialResult& result) { return result.inputs[input]; });
}

/// Writes the records of a table; a row takes as many of them as it has elements.
/// @param width size of the second dimension
template <class Record>
layout::TableIo write_table(hdf5::File& file, const layout::Table& table,
                            const std::vector<layout::RecordField<Record>>& fields,
                            const std::vector<const Record*>& records, std::int64_t width,
                            hdf5::Compression compression) {
  const std::int64_t of_last = table.last ? std::ssize(table.last->values) : 1;
  const std::int64_t rows = std::ssize(records) / (width * of_last);
  layout::TableIo io = layout::TableIo::create(file, table, rows, width, compression);
  layout::write_records(io, fields, 0, std::span(records));
  return io;
}

std::vector<const trial::MoveOutcome*> move_outcomes(std::span<const TrialResult> results) {
  std::vector<const trial::MoveOutcome*> moves;
  if (!results.empty()) moves.reserve(results.size() * results.front().outcome.moves.size());
  for (const TrialResult& result : results)
    for (const trial::MoveOutcome& move : result.outcome.moves) moves.push_back(&move);
  return moves;
}

/// [move][band], flattened.
std::vector<const trial::BandOutcome*> band_outcomes(std::span<const trial::MoveOutcome* const> moves,
                                                     const trial::ErrorBands& bands) {
  std::vector<const trial::BandOutcome*> outcomes;
  outcomes.reserve(moves.size() * bands.count);
  for (const trial::MoveOutcome* move : moves)
    for (std::size_t band = 0; band < bands.count; ++band) outcomes.push_back(&move->bands[band]);
  return outcomes;
}

/// [move][tolerance], flattened.
std::vector<layout::ToleranceRecord> tolerance_records(std::span<const trial::MoveOutcome* const> moves,
                                                       const trial::Tolerances& tolerances) {
  std::vector<layout::ToleranceRecord> records;
  records.reserve(moves.size() * tolerances.count);
  for (const trial::MoveOutcome* move : moves)
    for (std::size_t i = 0; i < tolerances.count; ++i) records.push_back({move->tolerance_settling_times[i]});
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

/// The regular files in `directory` whose names end in `extension`, in order of names.
std::vector<fs::path> files_in(const fs::path& directory, const char* extension) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;  // ignored: a vanished entry or a broken link is not a regular file
    if (entry->path().extension() == extension && entry->is_regular_file(unknown)) {
      files.push_back(entry->path());
    }
  }
  if (error) storage::fail_with(directory, "read the directory", error.value());
  std::sort(files.begin(), files.end());
  return files;
}

/// Writes /trial, /outcome, /jerk and, if trials are retained, /trace.
void write_trial_tables(hdf5::File& file, const study::Study& study, std::span<const TrialResult> trials,
                        const ShardOptions& options) {
  const hdf5::Compression compression = options.compression;
  const study::StudyFeatures& features = study.features;
  const layout::MeasureTable& measures =
      options.measures != nullptr ? *options.measures : layout::measure_table(features);
  write_trials(file, study, trials, compression);
  const std::vector<const trial::MoveOutcome*> moves = move_outcomes(trials);
  layout::TableIo outcomes = write_table(
      file, layout::outcome_table(layout::format_version, features, measures),
      layout::move_fields(layout::format_version, features, measures), moves, study.moves, compression);
  write_row_numbers(outcomes, trials);
  write_table(file, layout::band_table(features.bands), layout::band_fields(),
              band_outcomes(moves, features.bands), study.moves, compression);
  if (features.tolerances.count > 0) {
    const auto records = tolerance_records(moves, features.tolerances);
    write_table(file, layout::tolerance_table(features.tolerances), layout::tolerance_fields(),
                layout::pointers_to(records), study.moves, compression);
  }
  const std::vector<layout::JerkRecord> jerks = jerk_records(trials);
  write_table(file, layout::jerk_table(), layout::jerk_fields(), layout::pointers_to(jerks), 1, compression)
      .number_rows(0);
  if (study.retained_trials.empty()) return;
  const std::vector<layout::TraceRecord> trace = trace_records(trials);
  write_table(file, layout::trace_table(features), layout::trace_fields(features), layout::pointers_to(trace),
              1, compression)
      .number_rows(0);
}

}  // namespace

fs::path shard_path(const fs::path& directory, layout::RowRange rows) {
  return directory / fmt::format("trials-{:012}-{:012}.h5", rows.first, rows.end() - 1);
}

void write_shard(const fs::path& path, const study::Study& study, layout::RowRange rows,
                 std::span<const TrialResult> trials, std::span<const layout::PointSums> sums,
                 const ShardOptions& options) {
  require_fit(study, rows, trials, sums);
  const storage::UnfinishedFile part(path);
  hdf5::File file = hdf5::File::create(part.path());
  layout::write_header(file, layout::make_header(study, layout::FileKind::shard, rows, options.provenance));
  if (layout::has_trials(study.retention)) write_trial_tables(file, study, trials, options);
  if (layout::has_sums(study.retention)) layout::write_sums(file, rows.first / study.trials, sums);
  layout::mark_finished(file);
  finish_results(path, file.close());
}

void finish_results(const fs::path& path, const hdf5::WrittenValues& written) {
  const fs::path part = storage::part_of(path);
  storage::append_checksum(part);
  if (storage::check_checksum(part) != storage::ChecksumState::valid)
    storage::fail_read_back(part, "the checksum at its end differs");
  hdf5::require_written(part, written);
  storage::publish(path);
}

layout::FileHeader inspect_header(const fs::path& path, layout::Checksum checksum) {
  layout::FileHeader header = layout::read_header(layout::open_results(path, checksum));
  if (header.finished) return header;
  throw Failure(ExitCode::bad_data, fmt::format("{}: damaged: it was never finished", path.string()));
}

bool keeps_every_trial(const fs::path& path) {
  return !layout::has_sums(inspect_header(path, layout::Checksum::not_yet).retention);
}

std::vector<fs::path> shard_files(const fs::path& directory) {
  return files_in(directory, ".h5");
}

void sort_by_rows(std::vector<ShardInfo>& shards) {
  std::stable_sort(shards.begin(), shards.end(), [](const ShardInfo& left, const ShardInfo& right) {
    return left.rows.first < right.rows.first;
  });
}

reading::ResultsFile open_shard(const fs::path& path, const study::Study& study) {
  reading::ResultsFile file(path, reading::Require::any_part);
  layout::require_same_study(path, file.header(), study);
  return file;
}

void check_values(const reading::ResultsFile& shard, const study::Study& study) {
  if (!shard.trials()) return;
  shard.trials()->require_valid_values();
  shard.trials()->for_each_block([&](layout::RowRange block) {
    reading::check_inputs(*shard.trials(), study, block, [&](const std::string& problem) {
      throw Failure(ExitCode::bad_data, fmt::format("{}: {}", shard.path().string(), problem));
    });
  });
}

ShardSurvey list_shards(const fs::path& directory, const study::Study& study, const ShardCheck& check) {
  ShardSurvey survey;
  std::error_code error;
  const bool exists = fs::exists(directory, error);
  if (error) storage::fail_with(directory, "read the directory", error.value());
  if (!exists) return survey;
  survey.unfinished = files_in(directory, ".part");
  for (const fs::path& path : shard_files(directory)) {
    try {
      const reading::ResultsFile shard = open_shard(path, study);
      if (check) check(shard, study);
      survey.shards.push_back({path, shard.rows()});
    } catch (const layout::ForeignFile& foreign) {
      survey.problems.push_back({path, foreign.what(), ShardProblem::Kind::foreign});
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::bad_data) throw;
      survey.problems.push_back({path, failure.what(), ShardProblem::Kind::damaged});
    }
  }
  sort_by_rows(survey.shards);
  return survey;
}

std::vector<layout::RowRange> missing_ranges(std::span<const ShardInfo> shards, layout::RowRange wanted) {
  std::vector<ShardInfo> ordered(shards.begin(), shards.end());
  sort_by_rows(ordered);
  std::vector<layout::RowRange> missing;
  std::int64_t next = wanted.first;
  for (const ShardInfo& shard : ordered) {
    const std::int64_t end = std::min(shard.rows.first, wanted.end());
    if (end > next) missing.push_back({next, end - next});
    next = std::max(next, shard.rows.end());
  }
  if (next < wanted.end()) missing.push_back({next, wanted.end() - next});
  return missing;
}

void remove_unfinished(const ShardSurvey& survey) {
  for (const fs::path& path : survey.unfinished) {
    std::error_code error;
    fs::remove(path, error);
    if (error) storage::fail_with(path, "remove", error.value());
  }
}

}  // namespace zerocount::shards
