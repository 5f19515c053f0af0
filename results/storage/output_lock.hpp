#pragma once

#include <filesystem>

#include "results/storage/file_descriptor.hpp"

namespace zerocount::storage {

/// Exclusive lock on an output: flock on the empty file OUTPUT.lock, which the destructor removes. The system
/// releases the lock if the process dies.
class OutputLock {
 public:
  /// @throws Failure (machine_failed) if another run holds the lock or the lock file cannot be created.
  explicit OutputLock(const std::filesystem::path& output);
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;
  ~OutputLock();

 private:
  std::filesystem::path path_;
  FileDescriptor file_;
};

}  // namespace zerocount::storage
