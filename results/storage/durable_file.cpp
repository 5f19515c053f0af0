#include "results/storage/durable_file.hpp"

#include <cerrno>
#include <cstdlib>
#include <optional>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "core/failure/failure.hpp"
#include "results/storage/output_file.hpp"

namespace zerocount::storage {

namespace {

namespace fs = std::filesystem;

fs::path directory_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Whether the error number (errno) means that the file system has no fsync for directories, so that nothing
/// more can be done.
bool has_no_fsync(int error) {
  return error == EINVAL || error == EOPNOTSUPP || error == ENOSYS;
}

/// Flushes the directory entry of `path` to the disk, so that the name survives a crash.
void synchronise_name(const fs::path& path) {
  const FileDescriptor directory(::open(directory_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!directory.valid() || (::fsync(directory.get()) != 0 && !has_no_fsync(errno)))
    fail_with(path, "bring its name to the disk", errno);
}

/// The status of the regular file at `path` that is to be replaced; empty if there is none.
std::optional<struct stat> file_to_replace(const fs::path& path) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) != 0) return std::nullopt;
  if (!S_ISREG(there.st_mode)) fail_irregular(path);
  // The administrator may write to any file, but who protected it meant that too.
  constexpr mode_t writable_by_anyone = S_IWUSR | S_IWGRP | S_IWOTH;
  if ((there.st_mode & writable_by_anyone) == 0 ||
      ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
    throw Failure(
        ExitCode::machine_failed,
        fmt::format("{}: cannot be replaced: it is write-protected; make it writable (chmod u+w), or "
                    "name another output",
                    path.string()));
  }
  return there;
}

/// Gives the file at `path` the permissions of the file that it replaces and, as far as the system allows,
/// its owner and group.
void take_permissions(const fs::path& path, const struct stat& replaced) {
  [[maybe_unused]] const int refused = ::lchown(path.c_str(), replaced.st_uid, replaced.st_gid);
  constexpr mode_t permissions = S_IRWXU | S_IRWXG | S_IRWXO;
  if (::chmod(path.c_str(), replaced.st_mode & permissions) != 0)
    fail_with(path, "give it the permissions of the file that it replaces", errno);
}

void remove_leftover(const fs::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;
  if (!S_ISREG(status.st_mode)) fail_irregular(path);
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail_with(path, "remove", errno);
}

}  // namespace

void fail_irregular(const fs::path& path) {
  throw Failure(
      ExitCode::machine_failed,
      fmt::format(
          "{}: cannot be written: it exists and is not a regular file; remove it, or name another output",
          path.string()));
}

void fail_read_back(const fs::path& path, std::string_view what) {
  throw Failure(ExitCode::machine_failed,
                fmt::format("{}: what was written is not what is read back: {}", path.string(), what));
}

void fail_with(const fs::path& path, std::string_view action, int error) {
  throw Failure(ExitCode::machine_failed, fmt::format("{}: cannot {}: {}", path.string(), action,
                                                      std::system_category().message(error)));
}

fs::path part_of(const fs::path& path) {
  fs::path part = path;
  part += ".part";
  return part;
}

FileDescriptor create_file(const fs::path& path) {
  remove_leftover(path);
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!file.valid()) fail_with(path, "open for writing", errno);
  return file;
}

void require_replaceable(const fs::path& path) {
  file_to_replace(path);
}

UnfinishedFile::UnfinishedFile(const fs::path& path) : part_(part_of(path)) {
  require_replaceable(path);
  remove_leftover(part_);
}

UnfinishedFile::~UnfinishedFile() {
  ::unlink(part_.c_str());
}

bool is_named(const FileDescriptor& file, const fs::path& path) {
  struct stat named {};
  struct stat held {};
  return ::lstat(path.c_str(), &named) == 0 && ::fstat(file.get(), &held) == 0 &&
         named.st_ino == held.st_ino && named.st_dev == held.st_dev;
}

void publish(const fs::path& path) {
  const std::optional<struct stat> replaced = file_to_replace(path);
  const fs::path part = part_of(path);
  if (replaced) take_permissions(part, *replaced);
  if (::rename(part.c_str(), path.c_str()) != 0)
    fail_with(part, fmt::format("rename to {}", path.filename().string()), errno);
  synchronise_name(path);
}

void synchronise(const fs::path& path, const FileDescriptor& file) {
  if (::fsync(file.get()) != 0) fail_with(path, "bring to the disk", errno);
  ::posix_fadvise(file.get(), 0, 0, POSIX_FADV_DONTNEED);  // only a hint; some file systems ignore it
}

void write_all(const fs::path& path, const FileDescriptor& file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file.get(), text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_with(path, "write", errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void replace_file(const fs::path& path, std::string_view bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.finish();
  file.publish();
}

void make_directory(const fs::path& path) {
  if (::mkdir(path.c_str(), 0777) != 0) {
    if (errno == ENOENT && path.has_parent_path() && path.parent_path() != path) {
      make_directory(path.parent_path());
      return make_directory(path);
    }
    std::error_code ignored;
    if (errno == EEXIST && fs::is_directory(path, ignored)) return;
    fail_with(path, "make the directory", errno);
  }
  synchronise_name(path);
}

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error);
  if (error) fail_with("the folder for temporary files (TMPDIR)", "find it", error.value());
  std::string pattern = (place / "zerocount-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) fail_with(pattern, "make the folder", errno);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path ScratchFolder::make() {
  const std::lock_guard lock(mutex_);
  if (is_closed_)
    throw Failure(ExitCode::interrupted, "interrupted: the folder for temporary files is closed");
  folder_.reset();
  return folder_.emplace().path();
}

void ScratchFolder::remove() {
  const std::lock_guard lock(mutex_);
  folder_.reset();
}

void ScratchFolder::close() {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  if (!folder_) return;
  // Under another name nobody makes a file in it while its contents are removed.
  const std::filesystem::path hidden = folder_->path().string() + ".removed";
  std::error_code ignored;
  std::filesystem::rename(folder_->path(), hidden, ignored);
  std::filesystem::remove_all(hidden, ignored);
  folder_.reset();
}

}  // namespace zerocount::storage
