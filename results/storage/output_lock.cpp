#include "results/storage/output_lock.hpp"

#include <cerrno>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "core/failure/failure.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::storage {
namespace {

/// Follows no link, and does not wait for the other end of a pipe.
FileDescriptor open_lock(const std::filesystem::path& path) {
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
  if (!file.valid() && (errno == ELOOP || errno == EISDIR || errno == ENXIO)) fail_irregular(path);
  if (!file.valid()) fail_with(path, "make the lock file", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_with(path, "make the lock file", errno);
  if (!S_ISREG(status.st_mode)) fail_irregular(path);
  return file;
}

}  // namespace

OutputLock::OutputLock(const std::filesystem::path& output) : path_(output) {
  path_ += ".lock";
  do {
    file_ = open_lock(path_);
    if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) fail_with(path_, "lock", errno);
      throw Failure(
          ExitCode::machine_failed,
          fmt::format("{}: another run is writing this output (it holds {}); wait for it or stop it, or name "
                      "another output",
                      output.string(), path_.string()));
    }
    // Another run may have ended and removed the file between our open and our lock.
  } while (!is_named(file_, path_));
}

OutputLock::~OutputLock() {
  ::unlink(path_.c_str());
}

}  // namespace zerocount::storage
