#include "results/storage/output_lock.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstddef>
#include <string>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::storage {
namespace {

/// Opens a lock file without following a link, and without waiting for the other end of a pipe.
FileDescriptor open_lock(const std::filesystem::path& path) {
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
  if (!file.valid() && (errno == ELOOP || errno == EISDIR || errno == ENXIO)) fail_irregular(path);
  if (!file.valid()) fail_with(path, "make the lock file", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_with(path, "make the lock file", errno);
  if (!S_ISREG(status.st_mode)) fail_irregular(path);
  return file;
}

/// Tries to get an flock on the file for a short time, because lock_state() of another process may hold it
/// for a moment.
/// @returns 0, or the error number (errno).
int lock(const FileDescriptor& file) {
  constexpr int tries = 5;
  for (int i = 1;; ++i) {
    if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) return 0;
    if (errno != EWOULDBLOCK || i == tries) return errno;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// Writes this_machine() to the lock file, for lock_state(). A failure does not matter, because the lock
/// holds without it.
void name_machine(const FileDescriptor& file) {
  const std::string machine = this_machine();
  if (::ftruncate(file.get(), 0) != 0) return;
  [[maybe_unused]] const ssize_t written = ::pwrite(file.get(), machine.data(), machine.size(), 0);
}

std::string machine_in(const FileDescriptor& file) {
  std::array<char, 64> text{};
  const ssize_t size = ::pread(file.get(), text.data(), text.size(), 0);
  return size < 0 ? std::string() : std::string(text.data(), static_cast<std::size_t>(size));
}

/// Whether the error number (errno) means that flock(2) fails because a network file system has no locks on
/// its server, or is mounted without them.
bool has_no_flock(int error) {
  return error == EOPNOTSUPP || error == ENOSYS || error == ENOLCK || error == EINVAL;
}

}  // namespace

OutputLock::OutputLock(const std::filesystem::path& output) : path_(output) {
  path_ += ".lock";
  do {
    file_ = open_lock(path_);
    if (const int error = lock(file_); error != 0) {
      if (has_no_flock(error)) {
        ::unlink(path_.c_str());
        owner_.emplace(output);
        return;
      }
      if (error != EWOULDBLOCK) fail_with(path_, "lock", error);
      throw Failure(
          ExitCode::machine_failed,
          fmt::format("{}: another run is writing this output (it holds {}); wait for it or stop it, or name "
                      "another output",
                      output.string(), path_.string()));
    }
    // Another run may have ended and removed the file between our open and our lock.
  } while (!is_named(file_, path_));
  name_machine(file_);
}

LockState lock_state(const std::filesystem::path& output) {
  if (is_owned(output)) return LockState::held;
  std::filesystem::path path = output;
  path += ".lock";
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!file.valid()) return LockState::free;
  if (::flock(file.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK) return LockState::held;
  return machine_in(file) == this_machine() ? LockState::free : LockState::unknown;
}

OutputLock::~OutputLock() {
  if (!owner_) ::unlink(path_.c_str());
}

}  // namespace zerocount::storage
