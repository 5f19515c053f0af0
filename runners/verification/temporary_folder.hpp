#pragma once

#include <filesystem>

namespace zerocount::verification {

/// A temporary folder; the destructor removes it with its contents.
class TemporaryFolder {
 public:
  /// @throws Failure (machine_failed) with the path and the system's reason.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace zerocount::verification
