#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "results/storage/durable_file.hpp"

namespace zerocount::storage {

/// Name of this computer and its set of visible processes, valid until the computer restarts. Processes that
/// see each other by their process numbers get the same name.
std::string this_machine();

/// Timing of the owner lock: how often an owner renews its file to show that it is alive, and how long others
/// wait for that.
struct Heartbeat {
  std::chrono::milliseconds interval{20'000};
  /// Time without a renewal after which other processes take an owner for ended
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
  /// Takes the lock. Waits for up to `patience` if there is the file of another owner.
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

/// Whether an owner of the output has renewed its file lately, by the clock of this computer.
bool is_owned(const std::filesystem::path& output);

/// Exclusive lock on an output file: flock on the file OUTPUT.lock, which contains this_machine() and which
/// the destructor removes. The system releases the lock if the process dies. On a file system without flock,
/// an OwnerLock replaces it.
class OutputLock {
 public:
  /// Takes the lock.
  /// @throws Failure (machine_failed) if another run holds the lock or the lock file cannot be created.
  explicit OutputLock(const std::filesystem::path& output);
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;
  ~OutputLock();

  /// The OwnerLock that replaces flock on this file system; empty if the file system has flock.
  const std::optional<OwnerLock>& owner() const { return owner_; }

 private:
  std::filesystem::path path_;
  FileDescriptor file_;
  std::optional<OwnerLock> owner_;
};

/// Whether a process holds the lock on an output file.
enum class LockState {
  free,
  held,
  unknown  ///< There is a lock file of another computer, whose locks may not be visible here
};
LockState lock_state(const std::filesystem::path& output);

}  // namespace zerocount::storage
