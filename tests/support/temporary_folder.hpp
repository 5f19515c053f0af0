#pragma once

#include <filesystem>
#include <string>

#include "results/storage/durable_file.hpp"

namespace zerocount::testing {

/// The whole contents of a file; empty if it cannot be read.
std::string read_bytes(const std::filesystem::path& path);
/// Writes a file, replacing an existing one.
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// A new temporary folder. The destructor removes it with all its contents.
class TemporaryFolder : public storage::TemporaryFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& bytes) const;
  std::string read(const std::string& name) const;
};

}  // namespace zerocount::testing
