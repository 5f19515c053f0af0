#pragma once

#include <filesystem>
#include <string>

namespace zerocount::testing {

/// The whole contents of a file; empty where it cannot be read.
std::string read_bytes(const std::filesystem::path& path);
/// Writes a file in place of what stood there.
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// A fresh folder, removed at the end of its life with all it holds.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const;
  std::string read(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

}  // namespace zerocount::testing
