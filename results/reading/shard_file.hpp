#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "results/hdf5/element.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"
#include "results/storage/durable_file.hpp"

/// A shard: finished trials of a run that has not ended. Only the build that wrote a shard reads it, so that
/// it does not describe its columns:
///
///     "zerocount-shard V N\n"   version of the layout, bytes of the head
///     head                      ShardHead, as MessagePack
///     chunks                    of one column after the other, as a results file stores them
///                               (chunk_filters.hpp)
///     checksum trailer          SHA-256 of all bytes before it (file_contents.hpp)
namespace zerocount::reading {

struct ShardHead {
  struct Column {
    std::string path;  ///< Path of the dataset in the results file to which the column's rows will be joined
    std::int64_t rows{0};
    std::vector<std::uint64_t> chunks;  ///< Size of each stored chunk of the column, bytes
  };
  layout::FileHeader header;
  hdf5::Compression compression{hdf5::Compression::none};
  std::vector<Column> columns;
};

/// The bytes of a shard before its chunks: the first line and the head.
std::string bytes_of(const ShardHead& head);

/// Whether a file begins like a shard (finished trials of a run that has not ended). False also if it cannot
/// be read.
bool is_shard(const std::filesystem::path& path);

/// A shard (a file with finished trials of a run that has not ended), open to be read.
class ShardFile {
 public:
  /// Opens a shard.
  /// @throws ForeignFile for a shard of another version; Failure (bad_data) for damage, (machine_failed) if
  /// it cannot be read
  explicit ShardFile(const std::filesystem::path& path,
                     layout::Checksum checksum = layout::Checksum::required);

  const layout::FileHeader& header() const { return head_.header; }
  /// Opens the columns of one table in the shard; they may outlive this object. If the rows of the table are
  /// trials, the scale of the returned table holds their row numbers.
  /// @param second size of the second dimension, 1 if the table has none
  /// @throws ForeignFile for a shard of another build; Failure (bad_data) if a column is missing or the
  /// columns differ in size
  layout::TableReader open(const layout::Table& table, std::int64_t second) const;

 private:
  layout::TableReader::Column column(const layout::Table& table, const layout::Column& column,
                                     std::int64_t second) const;
  const ShardHead::Column* find(const std::string& path) const;
  [[noreturn]] void fail(const std::string& problem) const;

  std::filesystem::path path_;
  std::shared_ptr<const storage::FileDescriptor> file_;
  ShardHead head_;
  /// Position in the file of the first chunk of each column, [column], followed by the end of the last, bytes
  std::vector<std::uint64_t> begins_;
};

}  // namespace zerocount::reading
