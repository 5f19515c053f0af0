#pragma once

#include <filesystem>

namespace zerocount::storage {

/// A temporary folder; the destructor removes it with its contents.
class TemporaryFolder {
 public:
  /// @throws Failure (machine_failed) with the path and the system's reason.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace zerocount::storage
