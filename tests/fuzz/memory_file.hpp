#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "results/storage/durable_file.hpp"

namespace zerocount::fuzz {

/// A file in memory that has a path, for readers that open files themselves. Linux only.
class MemoryFile {
 public:
  MemoryFile();

  const std::filesystem::path& path() const { return path_; }
  void replace(std::string_view bytes);
  std::string bytes() const;

 private:
  storage::FileDescriptor file_;
  std::filesystem::path path_;
};

}  // namespace zerocount::fuzz
