#pragma once

#include <filesystem>
#include <string>

#include "results/storage/durable_file.hpp"

namespace zerocount::testing {

/// The whole contents of a file; empty where it cannot be read.
std::string read_bytes(const std::filesystem::path& path);
/// Writes a file in place of what stood there.
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// A fresh folder, removed at the end of its life with all it holds.
class TemporaryFolder : public storage::TemporaryFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& bytes) const;
  std::string read(const std::string& name) const;
};

}  // namespace zerocount::testing
