#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include <unistd.h>

namespace zerocount::storage {

/// When the contents of a file that is closed are flushed to the disk.
enum class Flush {
  now,
  later  ///< The caller brings the file to the disk by synchronise(), or by Flush::now when the file is
         /// < closed again.
};

/// Owner of an open POSIX file descriptor; the destructor closes it.
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

/// Name of a file while it is written: PATH.part. A file named PATH is therefore always complete, even if the
/// process that wrote it was killed.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Creates an empty file to read and write. A regular file of that name, which an interrupted process left,
/// is removed before. A link is not followed, and neither it nor a pipe, a device or a directory is replaced.
/// @throws Failure (machine_failed) with the path and the reason.
FileDescriptor create_file(const std::filesystem::path& path);

/// Checks early, before long work, that publish() will be able to put a file at `path`.
/// @throws Failure (machine_failed) if publish() would not replace what is there: something other than a
/// regular file, or a file that is write-protected.
void require_replaceable(const std::filesystem::path& path);

/// Owner of the unfinished file part_of(path). The constructor removes a file that an interrupted process
/// left there, as create_file() does. The destructor removes the file if it still exists, so that a failed
/// write leaves nothing on the disk.
class UnfinishedFile {
 public:
  /// Makes the place free.
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

/// Whether `path` names the open file itself, not a link to it.
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

/// Writes all of `text` at the file's current position; `path` is the file's name in error messages.
/// @throws Failure (machine_failed) with the path and the system's reason.
void write_all(const std::filesystem::path& path, const FileDescriptor& file, std::string_view text);

/// Replaces a file atomically: `path` holds either the old or all of the new contents.
/// @throws Failure (machine_failed) with the path and the system's reason.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

/// Creates the directory and its missing parents, and flushes their directory entries to the disk.
/// @throws Failure (machine_failed) with the path and the system's reason.
void make_directory(const std::filesystem::path& path);

/// Throws the error for a path that is to be created but names something other than a regular file.
/// @throws Failure (machine_failed)
[[noreturn]] void fail_irregular(const std::filesystem::path& path);

/// Throws the error for a file whose contents, read back, differ from the contents written.
/// @param what what differs, for the message.
/// @throws Failure (machine_failed)
[[noreturn]] void fail_read_back(const std::filesystem::path& path, std::string_view what);

/// Throws the error "PATH: cannot ACTION: reason".
/// @param error error number of the system (errno), which gives the reason.
/// @throws Failure (machine_failed)
[[noreturn]] void fail_with(const std::filesystem::path& path, std::string_view action, int error);

/// A temporary folder; the destructor removes it with its contents.
class TemporaryFolder {
 public:
  /// Creates the folder.
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

/// Holder of at most one temporary folder at a time. Another thread may call close() at any time, for example
/// before that thread ends the process.
class ScratchFolder {
 public:
  /// Creates an empty temporary folder, removes the previous one, and returns the new path.
  /// @throws as TemporaryFolder(), and Failure (interrupted) after close()
  std::filesystem::path make();
  /// Removes the temporary folder; make() can create another one.
  void remove();
  /// Removes the temporary folder for good, even if another thread may be writing in it.
  void close();

 private:
  std::mutex mutex_;
  bool is_closed_{false};
  std::optional<TemporaryFolder> folder_;
};

}  // namespace zerocount::storage
