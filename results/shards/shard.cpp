#include "results/shards/shard.hpp"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/reading/shard_file.hpp"
#include "results/shards/encoded_shard.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::shards {
namespace {

namespace fs = std::filesystem;

void require_fit(const study::Study& study, std::span<const TrialResult> trials) {
  for (const TrialResult& trial : trials) {
    if (trial.inputs.size() != study.columns.inputs.size() || std::ssize(trial.outcome.moves) != study.moves)
      throw std::invalid_argument(fmt::format("the result for row {} does not fit the study", trial.row));
  }
}

/// The regular files in `directory` whose names end in one of the extensions, in order of names.
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
