#pragma once

#include <filesystem>
#include <string_view>

#include "results/storage/file_descriptor.hpp"

namespace zerocount {

/// Where a file stands until it is finished: PATH.part. What has the name PATH is whole, whatever happened to
/// the process that wrote it.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Removes part_of(path) at the end of its life, if it is still there: a failed write must not hold on to the
/// disk.
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

/// For what never overwrites: @throws Failure (bad_input) where something has the name `path` already;
/// machine_failed with the system's reason where that cannot be found out.
void require_new(const std::filesystem::path& path);

/// Gives the finished file part_of(path), which is on the disk, its name `path`, durably; what had it before
/// is replaced.
/// @throws Failure (machine_failed) with the path and the system's reason. Where it is only the folder that
/// cannot be brought to the disk, the file has its name already.
void publish(const std::filesystem::path& path);

/// Brings what was written to an open file to the disk, and has the system drop its copy in memory, so that
/// the file is then read from the disk.
/// @throws Failure (machine_failed) with the path and the system's reason.
void synchronise(const std::filesystem::path& path, const FileDescriptor& file);

/// Writes all of `text` at the file's position; `path` is its name in messages.
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_all(const std::filesystem::path& path, const FileDescriptor& file, std::string_view text);

/// Writes a file that appears whole or not at all; what had its name before is replaced.
/// @throws Failure (machine_failed) with the path and the system's reason.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes the directory and those above it, durably.
/// @throws Failure (machine_failed) with the path and the system's reason.
void make_directory(const std::filesystem::path& path);

/// @throws Failure (machine_failed): what was written to the file is not what is there.
[[noreturn]] void fail_read_back(const std::filesystem::path& path, std::string_view what);

/// @throws Failure (machine_failed): "PATH: cannot ACTION: reason of `error`" (an errno).
[[noreturn]] void fail_with(const std::filesystem::path& path, std::string_view action, int error);

}  // namespace zerocount
