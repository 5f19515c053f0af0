#pragma once

#include <filesystem>
#include <optional>

#include "results/storage/file_descriptor.hpp"
#include "results/storage/owner_lock.hpp"

namespace zerocount::storage {

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
