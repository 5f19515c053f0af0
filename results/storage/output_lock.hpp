#pragma once

#include <filesystem>

#include "results/storage/file_descriptor.hpp"

namespace zerocount {

/// The right to write an output: held by one process at a time, and released by the system if that process
/// dies. It is a lock (flock) on the empty file OUTPUT.lock, which is removed at the end.
class OutputLock {
 public:
  /// @throws Failure (machine_failed) where another run holds the lock, or the lock file cannot be made.
  explicit OutputLock(const std::filesystem::path& output);
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;
  ~OutputLock();

 private:
  std::filesystem::path path_;
  FileDescriptor file_;
};

}  // namespace zerocount
