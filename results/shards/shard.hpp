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

/// Path in `directory` of the shard (file with finished trials) that holds the trials `rows`.
std::filesystem::path shard_path(const std::filesystem::path& directory, layout::RowRange rows);

/// Finishes a results file: reads the closed file part_of(path) back, appends its checksum trailer, flushes
/// it to the disk, and renames it to `path`.
/// @param written bytes that were written to the file.
/// @throws Failure (machine_failed) if the file cannot be flushed or read, or if its contents differ from
/// `written`.
void finish_results(const std::filesystem::path& path, const storage::WrittenBytes& written);

/// Compression of shards, files with finished trials. Shards are read once and then removed: compressing them
/// takes longer than it saves, unless the results file can take over compressed chunks (see concatenate()).
inline constexpr hdf5::Compression shard_compression = hdf5::Compression::none;

struct ShardOptions {
  layout::Provenance provenance{layout::current_provenance()};
  hdf5::Compression compression{shard_compression};  ///< Compression of the tables of trials in the shard
  /// Measures of the moves that the shard has; null: the measures of this program, with the study's error
  /// bands
  const layout::MeasureTable* measures{nullptr};
};

/// Writes a shard, a file with what the study keeps of the finished trials `rows`. `path` appears when the
/// shard is complete on the disk.
/// @param trials all of these trials or, if the study keeps only failures, the failures among them, in order
/// of rows.
/// @param sums sums over all of these trials, [point] from the point of the first row on; empty if the study
/// keeps every trial.
/// @throws Failure (machine_failed) with the path and the reason; std::invalid_argument if the trials do not
/// fit the rows and the study.
void write_shard(const std::filesystem::path& path, const study::Study& study, layout::RowRange rows,
                 std::span<const TrialResult> trials, std::span<const layout::PointSums> sums = {},
                 const ShardOptions& options = {});

/// Path and rows of a complete shard, or of a part of the study.
struct ShardInfo {
  std::filesystem::path path;
  layout::RowRange rows;
};

/// Sorts the shards by their first row; shards with the same first row keep their order.
void sort_by_rows(std::vector<ShardInfo>& shards);

/// A shard or part that cannot be used, and why.
struct ShardProblem {
  enum class Kind {
    damaged,  ///< The file is damaged, and its trials are lost.
    foreign   ///< The file is valid, but belongs to another study or another build of the program, or has
              /// < another format or version (ForeignFile).
  };

  std::filesystem::path path;
  std::string problem;  ///< Complete error message, including the path
  Kind kind{Kind::damaged};
};

/// Contents of a folder of shards, after a check of each file.
struct ShardSurvey {
  std::vector<ShardInfo> shards;                  ///< Valid shards, in order of rows
  std::vector<ShardProblem> problems;             ///< Shards that are damaged or foreign, in order of paths
  std::vector<std::filesystem::path> unfinished;  ///< Files *.part that a killed process has left; they can
                                                  /// < be removed
};

/// The shards and parts in `directory`: its regular files *.shard and *.h5, sorted by name.
/// @throws Failure (machine_failed) if the directory cannot be read.
std::vector<std::filesystem::path> shard_files(const std::filesystem::path& directory);

/// The header of a finished results file, part of a study, or shard. Pass Checksum::not_yet if the header
/// only decides how to open the file.
/// @throws as open_results and read_header do
layout::FileHeader inspect_header(const std::filesystem::path& path,
                                  layout::Checksum checksum = layout::Checksum::required);

/// The header of a shard or part. Neither its contents nor its checksum are checked.
/// @throws as inspect_header does
layout::FileHeader unchecked_header(const std::filesystem::path& path);

/// Whether the shard or part keeps every trial; otherwise it has sums over trials.
/// @throws as inspect_header does
bool keeps_every_trial(const std::filesystem::path& path);

/// The path and rows of a shard or part. Reads the whole file and checks its checksum trailer, format,
/// version, study, build and completion mark. Its values are not interpreted, because the checksum proves
/// them.
/// @throws ForeignFile or another Failure (bad_data) if it cannot be used; see also open_results.
ShardInfo checked_shard(const std::filesystem::path& path, const study::Study& study);

/// Checks all files of shard_files(directory). A missing directory has no shards; other files are ignored.
/// @throws Failure (machine_failed) if the directory or a file cannot be read. An unreadable file does not
/// count as damaged.
ShardSurvey list_shards(const std::filesystem::path& directory, const study::Study& study);

/// The ranges of rows in `wanted` that no shard covers, in ascending order. Shards may overlap.
std::vector<layout::RowRange> missing_ranges(std::span<const ShardInfo> shards, layout::RowRange wanted);

/// Removes the unfinished files *.part of the folder, which killed processes left behind.
void remove_unfinished(const ShardSurvey& survey);

/// The bytes of a shard, ready to be written to its file. Any thread can make and store one.
struct EncodedShard {
  layout::RowRange rows;
  reading::ShardHead head;
  std::vector<hdf5::EncodedRows> columns;  ///< Encoded columns, in the order in which the head lists them
};

/// Encodes finished trials as the bytes of a shard.
/// @param columns data that is kept of the trials `rows`.
/// @param sums as for write_shard().
/// @throws std::invalid_argument if they do not fit the rows and the study
EncodedShard encode_shard(const study::Study& study, layout::RowRange rows, TrialColumns&& columns,
                          std::vector<layout::PointSums>&& sums, const ShardOptions& options = {});

/// Writes the shard to a file, flushes it to the disk, reads it back from there, and renames it to `path`.
/// @throws Failure (machine_failed) with the path and the reason
void store_shard(const std::filesystem::path& path, const EncodedShard& shard);

}  // namespace zerocount::shards
