#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include <unistd.h>

namespace zerocount::storage {

/// Time at which a file that is closed is brought to the disk.
enum class Flush {
  now,
  later  ///< The caller brings the file to the disk by synchronise(), or by Flush::now when the file is
         ///< closed again.
};

/// A POSIX file descriptor that its destructor closes.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int number) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { close(); }

  int get() const { return number_; }
  bool valid() const { return number_ >= 0; }

  /// Returns false and sets errno on failure: some file systems report a failed write only here. A second
  /// call does nothing.
  bool close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_{-1};
};

/// Name of a file while it is written: PATH.part. A file named PATH is therefore always complete, even if a
/// process that wrote it was killed.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Creates an empty file to read and write. A regular file of that name, which an interrupted process left,
/// is removed before. A link is not followed, and neither it nor a pipe, a device or a directory is replaced.
/// @throws Failure (machine_failed) with the path and the reason.
FileDescriptor create_file(const std::filesystem::path& path);

/// Checks early, before long work, that `path` can be written.
/// @throws Failure (machine_failed) if publish() would not replace what is there: something other than a
/// regular file, or a file that is write-protected.
void require_replaceable(const std::filesystem::path& path);

/// The place of part_of(path), made free as by create_file(). The destructor removes the file there if it
/// still exists, so that a failed write leaves nothing on the disk.
class UnfinishedFile {
 public:
  /// @throws Failure (machine_failed) if something other than a regular file has that name; see also
  /// require_replaceable().
  explicit UnfinishedFile(const std::filesystem::path& path);
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile();

  const std::filesystem::path& path() const { return part_; }

 private:
  std::filesystem::path part_;
};

/// True if `path` names the open file itself, not a link to it.
bool is_named(const FileDescriptor& file, const std::filesystem::path& path);

/// Renames the finished and flushed file part_of(path) to `path` and flushes the directory. An existing file
/// `path` is replaced, and its permissions are kept; see require_replaceable().
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

/// @throws Failure (machine_failed): `path`, which is to be created, names something other than a regular
/// file.
[[noreturn]] void fail_irregular(const std::filesystem::path& path);

/// @throws Failure (machine_failed): the contents read back differ from the contents written.
[[noreturn]] void fail_read_back(const std::filesystem::path& path, std::string_view what);

/// @throws Failure (machine_failed): "PATH: cannot ACTION: reason of `error`" (an errno).
[[noreturn]] void fail_with(const std::filesystem::path& path, std::string_view action, int error);

/// A temporary folder; the destructor removes it with its contents.
class TemporaryFolder {
 public:
  /// @throws Failure (machine_failed) with the path and the system's reason.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// A place for one temporary folder at a time. Another thread may close it at any time, for example before
/// that thread ends the process.
class ScratchFolder {
 public:
  /// Makes an empty folder in place of the previous one, and returns its path.
  /// @throws as TemporaryFolder(), and Failure (interrupted) after close()
  std::filesystem::path make();
  /// Removes the folder.
  void remove();
  /// Removes the folder for good, although another thread may be writing in it.
  void close();

 private:
  std::mutex mutex_;
  bool is_closed_{false};
  std::optional<TemporaryFolder> folder_;
};

}  // namespace zerocount::storage
