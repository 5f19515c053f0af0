#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/hdf5/element.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/point_sums.hpp"
#include "results/reading/shard_file.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/storage/written_bytes.hpp"

namespace zerocount::shards {

/// Path in `directory` of the shard with these rows.
std::filesystem::path shard_path(const std::filesystem::path& directory, layout::RowRange rows);

/// Reads the closed results file part_of(path) back, appends its checksum trailer, brings it to the disk, and
/// renames it to `path`.
/// @param written bytes that were written to the file.
/// @throws Failure (machine_failed) if the file cannot be flushed or read, or if its contents differ.
void finish_results(const std::filesystem::path& path, const storage::WrittenBytes& written);

/// Shards are read once and then removed: compressing them takes longer than it saves, unless the results
/// file can take over compressed chunks (see concatenate).
inline constexpr hdf5::Compression shard_compression = hdf5::Compression::none;

struct ShardOptions {
  layout::Provenance provenance{layout::current_provenance()};
  hdf5::Compression compression{shard_compression};  ///< Compression of the tables of trials
  /// Measures of the moves; null: the measures of this program, with the study's bands
  const layout::MeasureTable* measures{nullptr};
};

/// Writes what the study keeps of the trials `rows` as one shard: `trials`, in order of rows, are all of
/// these trials or the failures among them. `sums`, [point] from the point of the first row on, cover all of
/// these trials if the study does not keep every trial; otherwise they are empty. `path` appears when the
/// shard is complete on the disk.
/// @throws Failure (machine_failed) with the path and the reason; std::invalid_argument if the trials do not
/// fit the rows and the study.
void write_shard(const std::filesystem::path& path, const study::Study& study, layout::RowRange rows,
                 std::span<const TrialResult> trials, std::span<const layout::PointSums> sums = {},
                 const ShardOptions& options = {});

/// A complete shard (or part) of the study.
struct ShardInfo {
  std::filesystem::path path;
  layout::RowRange rows;
};

/// Sorts by the first row; shards with the same first row keep their order.
void sort_by_rows(std::vector<ShardInfo>& shards);

/// A file that cannot be used, and why.
struct ShardProblem {
  enum class Kind {
    damaged,  ///< The file is damaged and its trials are lost.
    foreign   ///< The file is valid, but of another study, another build, or another or newer format
              ///< (ForeignFile).
  };

  std::filesystem::path path;
  std::string problem;  ///< Complete message, including the path
  Kind kind{Kind::damaged};
};

/// Contents of a folder of shards.
struct ShardSurvey {
  std::vector<ShardInfo> shards;                  ///< Valid shards, in order of rows
  std::vector<ShardProblem> problems;             ///< Damaged or foreign files, in order of paths
  std::vector<std::filesystem::path> unfinished;  ///< Files *.part, left by a killed process; safe to remove
};

/// The regular files *.shard and *.h5 (parts) in `directory`, sorted by name.
/// @throws Failure (machine_failed) if the directory cannot be read.
std::vector<std::filesystem::path> shard_files(const std::filesystem::path& directory);

/// The header of a finished results file, part or shard. Pass Checksum::not_yet if the header only decides
/// how to open the file.
/// @throws as open_results and read_header do
layout::FileHeader inspect_header(const std::filesystem::path& path,
                                  layout::Checksum checksum = layout::Checksum::required);

/// The header of a shard or part, without a check of its contents and its end.
/// @throws as inspect_header does
layout::FileHeader unchecked_header(const std::filesystem::path& path);

/// Whether the file has every trial; otherwise it has sums. @throws as inspect_header does
bool keeps_every_trial(const std::filesystem::path& path);

/// The rows of a shard or part. Reads the whole file and checks its checksum trailer, format, version, study,
/// build and completion mark. Its values are not read, because the checksum proves them.
/// @throws ForeignFile or another Failure (bad_data) if it cannot be used; see also open_results.
ShardInfo checked_shard(const std::filesystem::path& path, const study::Study& study);

/// Checks shard_files(directory). A missing directory has no shards; other files are ignored.
/// @throws Failure (machine_failed) if the directory or a file cannot be read. An unreadable file does not
/// count as damaged.
ShardSurvey list_shards(const std::filesystem::path& directory, const study::Study& study);

/// The ranges of `wanted` that no shard covers, in order. Shards may overlap.
std::vector<layout::RowRange> missing_ranges(std::span<const ShardInfo> shards, layout::RowRange wanted);

/// Removes the files that killed processes left behind.
void remove_unfinished(const ShardSurvey& survey);

/// A shard in its stored form. Any thread can encode and store one.
struct EncodedShard {
  layout::RowRange rows;
  reading::ShardHead head;
  std::vector<hdf5::EncodedRows> columns;  ///< Columns that the head lists
};

/// Encodes a shard.
/// @param columns data that is kept of the trials `rows`. @param sums as for write_shard().
/// @throws std::invalid_argument if they do not fit the rows and the study
EncodedShard encode_shard(const study::Study& study, layout::RowRange rows, TrialColumns&& columns,
                          std::vector<layout::PointSums>&& sums, const ShardOptions& options = {});

/// Writes the file, brings it to the disk, reads it from there, and gives it its name.
/// @throws Failure (machine_failed) with the path and the reason
void store_shard(const std::filesystem::path& path, const EncodedShard& shard);

}  // namespace zerocount::shards
