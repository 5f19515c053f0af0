#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "results/storage/durable_file.hpp"

namespace zerocount::storage {

/// Name of this computer that is valid until it restarts. Processes that see each other by their process
/// numbers get the same name.
std::string this_machine();

/// Timing by which an owner shows that it is alive, and by which others wait for that.
struct Heartbeat {
  std::chrono::milliseconds interval{20'000};
  /// An owner that has not shown itself for this time has ended.
  std::chrono::milliseconds patience{90'000};
};

/// Exclusive lock on an output on a file system without flock: the empty file
/// OUTPUT.owner-HOST-MACHINE-PROCESS-RANDOM, which the destructor removes. Its time of modification is
/// renewed while the owner lives. The file system needs only files that exactly one process can create
/// (O_EXCL), and times of modification that change. Clocks need not agree.
///
/// A process first makes its own file and then looks for others. If two begin at once, at least one of them
/// sees the other's file. A file that is not renewed belongs to an owner that was killed, on whatever host,
/// and is removed. MACHINE identifies the boot and the process-id namespace. If an owner has the same one,
/// the system tells at once whether it has ended.
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

  /// The lock that replaces flock; empty if the file system has flock.
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
  unknown  ///< There is a lock file of another machine, whose locks may not be seen here
};
LockState lock_state(const std::filesystem::path& output);

}  // namespace zerocount::storage
