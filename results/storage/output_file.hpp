#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/hash/sha256.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_descriptor.hpp"

namespace zerocount {

/// A new file that is written from its beginning to its end. It stands at PATH.part until publish(), and is
/// removed if that never comes. What has the name PATH is whole.
/// @throws Failure (machine_failed) with the path and the reason, from every function.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);

  void write(std::string_view text);
  /// Brings the rest to the disk, reads the file back and compares it with what was written. Nothing can be
  /// written after it.
  void finish();
  void publish();  ///< gives the finished file its name; what had it before is replaced

 private:
  void flush();

  std::filesystem::path path_;
  UnfinishedFile part_;
  FileDescriptor file_;
  std::string buffer_;
  std::size_t size_{0};  ///< of what was handed to the system
  Sha256Hash written_;
};

}  // namespace zerocount
