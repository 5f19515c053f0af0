#pragma once

#include <filesystem>
#include <string_view>

#include "results/storage/file_descriptor.hpp"

namespace zerocount::storage {

/// Name of a file while it is written: PATH.part. A file named PATH is therefore always complete, even if a
/// process that wrote it was killed.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Its destructor removes part_of(path) if the file still exists, so that a failed write leaves nothing on
/// the disk.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& path) : part_(part_of(path)) {}
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile();

  const std::filesystem::path& path() const { return part_; }

 private:
  std::filesystem::path part_;
};

/// Renames the finished and flushed file part_of(path) to `path` and flushes the directory. Replaces an
/// existing `path`.
/// @throws Failure (machine_failed) with the path and the system's reason. If only the flush of the directory
/// fails, the file has been renamed already.
void publish(const std::filesystem::path& path);

/// Flushes an open file to the disk and drops it from the page cache, so that the next read comes from the
/// disk.
/// @throws Failure (machine_failed) with the path and the system's reason.
void synchronise(const std::filesystem::path& path, const FileDescriptor& file);

/// Writes all of `text` at the file's position; `path` is its name in messages.
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_all(const std::filesystem::path& path, const FileDescriptor& file, std::string_view text);

/// Replaces a file atomically: `path` holds either the old or all of the new contents.
/// @throws Failure (machine_failed) with the path and the system's reason.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

/// Creates the directory and its parents, and flushes their entries to the disk.
/// @throws Failure (machine_failed) with the path and the system's reason.
void make_directory(const std::filesystem::path& path);

/// @throws Failure (machine_failed): the contents read back differ from the contents written.
[[noreturn]] void fail_read_back(const std::filesystem::path& path, std::string_view what);

/// @throws Failure (machine_failed): "PATH: cannot ACTION: reason of `error`" (an errno).
[[noreturn]] void fail_with(const std::filesystem::path& path, std::string_view action, int error);

}  // namespace zerocount::storage
