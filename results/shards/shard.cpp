#include "results/shards/shard.hpp"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/shard_file.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"
#include "results/storage/output_file.hpp"

namespace zerocount::shards {
namespace {

void require_fit(const study::Study& study, layout::RowRange rows, const TrialColumns& columns,
                 std::span<const layout::PointSums> sums) {
  const bool sparse = layout::has_sums(study.retention);
  const std::int64_t points = (rows.end() - 1) / study.trials - rows.first / study.trials + 1;
  if (rows.count < 1 || rows.first < 0 || rows.end() > study::trial_count(study) ||
      (!sparse && std::ssize(columns.rows) != rows.count) || std::ssize(sums) != (sparse ? points : 0))
    throw std::invalid_argument("a shard needs trials of its study");
  std::int64_t next = rows.first;
  for (const std::int64_t row : columns.rows) {
    if (sparse ? row < next || row >= rows.end() : row != next)
      throw std::invalid_argument(fmt::format("the result for row {} does not fit the study", row));
    next = row + 1;
  }
}

/// Collects the columns of a shard and encodes them together, so that several threads can encode their
/// chunks.
class Encoding {
 public:
  explicit Encoding(EncodedShard& shard) : shard_(shard) {}

  void add(const std::string& group, const layout::Column& column, const hdf5::Storage& storage,
           const void* data) {
    const auto rows = static_cast<std::int64_t>(storage.extent[0]);
    shard_.head.columns.push_back({group + "/" + column.name, rows, {}});
    rows_.push_back({hdf5::chunk_shape_of(storage).value(), rows, data});
  }

  void add(const layout::Table& table, std::size_t column, std::int64_t rows, std::int64_t second,
           hdf5::Compression compression, const void* data) {
    add(table.group, table.columns[column],
        layout::column_storage(table, table.columns[column], rows, second, compression), data);
  }

  void encode() {
    shard_.columns = hdf5::encode_rows(rows_);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (const hdf5::EncodedChunk& chunk : shard_.columns[i].chunks)
        shard_.head.columns[i].chunks.push_back(chunk->size());
  }

 private:
  EncodedShard& shard_;
  std::vector<hdf5::RowsToEncode> rows_;
};

namespace fs = std::filesystem;

void require_fit(const study::Study& study, std::span<const TrialResult> trials) {
  for (const TrialResult& trial : trials) {
    if (trial.inputs.size() != study.columns.inputs.size() || std::ssize(trial.outcome.moves) != study.moves)
      throw std::invalid_argument(fmt::format("the result for row {} does not fit the study", trial.row));
  }
}

/// The regular files in `directory` whose names end in one of the extensions, sorted by name.
std::vector<fs::path> files_in(const fs::path& directory, std::initializer_list<const char*> extensions) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;  // ignored: a vanished entry or a broken link is not a regular file
    if (std::ranges::count(extensions, entry->path().extension()) > 0 && entry->is_regular_file(unknown))
      files.push_back(entry->path());
  }
  if (error) storage::fail_with(directory, "read the directory", error.value());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

EncodedShard encode_shard(const study::Study& study, layout::RowRange rows, TrialColumns&& columns,
                          std::vector<layout::PointSums>&& sums, const ShardOptions& options) {
  require_fit(study, rows, columns, sums);
  EncodedShard shard{rows,
                     {layout::make_header(study, layout::FileKind::shard, rows, options.provenance),
                      options.compression,
                      {}},
                     {}};
  Encoding encoding(shard);
  const layout::SumColumns all(sums);
  if (!sums.empty()) {
    const auto add = [&](const layout::Table& table, std::size_t column, const auto& values) {
      encoding.add(table, column, std::ssize(values), 1, hdf5::Compression::deflate, values.data());
    };
    add(layout::sums_table(), 0, all.whole_counts);
    add(layout::sums_table(), 1, all.real_counts);
    add(layout::whole_sums_table(), 0, all.whole);
    add(layout::real_sums_table(), 0, all.real);
  }
  if (layout::has_trials(study.retention)) {
    const layout::MeasureTable& measures =
        options.measures != nullptr ? *options.measures : layout::measure_table(study.features);
    const std::vector<ShardTable> tables = shard_tables(study, measures);
    if (columns.tables.empty()) columns.tables = columns_of(study, measures, {}).tables;
    const layout::Table& trials = tables.front().table;
    encoding.add(trials.group, trials.rows, layout::scale_storage(trials.rows, std::ssize(columns.rows)),
                 columns.rows.data());
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const TableColumns& values = columns.tables[i];
      for (std::size_t k = 0; k < values.columns.size(); ++k)
        encoding.add(tables[i].table, k, values.rows, tables[i].second, options.compression,
                     values.columns[k].data());
    }
  }
  encoding.encode();
  return shard;
}

void store_shard(const std::filesystem::path& path, const EncodedShard& shard) {
  storage::OutputFile file(path);
  file.write(reading::bytes_of(shard.head));
  for (const hdf5::EncodedRows& column : shard.columns)
    for (const hdf5::EncodedChunk& chunk : column.chunks)
      file.write(std::string_view(reinterpret_cast<const char*>(chunk->data()), chunk->size()));
  file.finish_with_checksum();
  file.publish();
}

fs::path shard_path(const fs::path& directory, layout::RowRange rows) {
  return directory / fmt::format("trials-{:012}-{:012}.shard", rows.first, rows.end() - 1);
}

void write_shard(const fs::path& path, const study::Study& study, layout::RowRange rows,
                 std::span<const TrialResult> trials, std::span<const layout::PointSums> sums,
                 const ShardOptions& options) {
  require_fit(study, trials);
  const layout::MeasureTable& measures =
      options.measures != nullptr ? *options.measures : layout::measure_table(study.features);
  store_shard(path, encode_shard(study, rows, columns_of(study, measures, trials), {sums.begin(), sums.end()},
                                 options));
}

void finish_results(const fs::path& path, const storage::WrittenBytes& written) {
  storage::publish_compared(path, written.require_in(storage::part_of(path)));
}

layout::FileHeader unchecked_header(const fs::path& path) {
  if (reading::is_shard(path)) return reading::ShardFile(path, layout::Checksum::not_yet).header();
  return layout::read_header(hdf5::File::open_to_read(path));
}

layout::FileHeader inspect_header(const fs::path& path, layout::Checksum checksum) {
  if (reading::is_shard(path)) return reading::ShardFile(path, checksum).header();
  layout::FileHeader header = layout::read_header(layout::open_results(path, checksum));
  if (header.finished) return header;
  throw Failure(ExitCode::bad_data, fmt::format("{}: damaged: it was never finished", path.string()));
}

bool keeps_every_trial(const fs::path& path) {
  return !layout::has_sums(inspect_header(path, layout::Checksum::not_yet).retention);
}

std::vector<fs::path> shard_files(const fs::path& directory) {
  return files_in(directory, {".h5", ".shard"});
}

void sort_by_rows(std::vector<ShardInfo>& shards) {
  std::stable_sort(shards.begin(), shards.end(), [](const ShardInfo& left, const ShardInfo& right) {
    return left.rows.first < right.rows.first;
  });
}

ShardInfo checked_shard(const fs::path& path, const study::Study& study) {
  const layout::FileHeader header = inspect_header(path);
  layout::require_same_study(path, header, study);
  return {path, header.rows};
}

ShardSurvey list_shards(const fs::path& directory, const study::Study& study) {
  ShardSurvey survey;
  std::error_code error;
  const bool exists = fs::exists(directory, error);
  if (error) storage::fail_with(directory, "read the directory", error.value());
  if (!exists) return survey;
  survey.unfinished = files_in(directory, {".part"});
  for (const fs::path& path : shard_files(directory)) {
    try {
      survey.shards.push_back(checked_shard(path, study));
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
