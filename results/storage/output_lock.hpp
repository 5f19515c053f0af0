#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "results/storage/durable_file.hpp"

namespace zerocount::storage {

/// A name of this machine until it is started anew: the same for processes that see each other by their
/// numbers.
std::string this_machine();

/// How an owner shows that it is alive, and how long others wait for that.
struct Heartbeat {
  std::chrono::milliseconds interval{20'000};
  std::chrono::milliseconds patience{90'000};  ///< an owner that did not show itself for so long has ended
};

/// Exclusive lock on an output where the file system has no flock: the empty file
/// OUTPUT.owner-HOST-MACHINE-PROCESS-RANDOM, which the destructor removes. Its time of modification is
/// renewed while the owner lives. It needs nothing of a file system but files that only one process can make
/// (O_EXCL) and times of modification that change; clocks need not agree.
///
/// A process first makes its own file and then looks for others: of two that begin at once each sees the
/// other's file, or one does. A file that is not renewed is of an owner that was killed, on whatever host,
/// and is removed. MACHINE identifies the boot and the process-id namespace: of an owner with the same, the
/// system tells at once whether it has ended.
///
/// An owner whose file was removed, because it was halted for longer than the others' patience, ends its
/// process with exit code machine_failed at the next heartbeat: two must not write one output.
class OwnerLock {
 public:
  /// Waits for up to `patience` if there is the file of another owner.
  /// @throws Failure (machine_failed) if that owner lives, or the file cannot be made.
  explicit OwnerLock(const std::filesystem::path& output, Heartbeat heartbeat = {});

  const std::filesystem::path& path() const { return file_.path; }

 private:
  struct OwnFile {
    std::filesystem::path path;

    explicit OwnFile(std::filesystem::path file);
    OwnFile(const OwnFile&) = delete;
    OwnFile& operator=(const OwnFile&) = delete;
    ~OwnFile();
  };

  OwnFile file_;
  std::jthread heart_;
};

/// Whether an owner has shown itself lately, by the clock of this machine.
bool is_owned(const std::filesystem::path& output);

/// Exclusive lock on an output: flock on the file OUTPUT.lock with this_machine(), which the destructor
/// removes. The system releases the lock if the process dies. On a file system without flock, an OwnerLock.
class OutputLock {
 public:
  /// @throws Failure (machine_failed) if another run holds the lock or the lock file cannot be created.
  explicit OutputLock(const std::filesystem::path& output);
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;
  ~OutputLock();

  /// The lock that stands for flock; nothing where the file system has it.
  const std::optional<OwnerLock>& owner() const { return owner_; }

 private:
  std::filesystem::path path_;
  FileDescriptor file_;
  std::optional<OwnerLock> owner_;
};

/// Whether a process has an output locked.
enum class LockState {
  free,
  held,
  unknown  ///< there is a lock file of another machine, whose locks may not be seen here
};
LockState lock_state(const std::filesystem::path& output);

}  // namespace zerocount::storage
