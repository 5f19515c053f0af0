#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/hash/sha256.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::storage {

/// A new file that is written sequentially. It is named PATH.part until publish(), and is removed if
/// publish() is never called. If another process puts a file of its own there, that file is left as it is. A
/// file named PATH is therefore always complete.
/// @throws Failure (machine_failed) with the path and the reason, from every function.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  void write(std::string_view text);
  /// Flushes the file to the disk, reads it back and compares it with what was written. No write may follow.
  void finish();
  /// Writes the checksum trailer (see file_contents.hpp), then finishes the file as finish() does.
  void finish_with_checksum();
  /// Renames the finished file from PATH.part to its final name PATH; replaces an existing file. Fails if
  /// another process has put its own file in place of PATH.part.
  void publish();

 private:
  void flush();

  std::filesystem::path path_;
  std::filesystem::path part_;
  FileDescriptor file_;  ///< Open file; it stays open until the end, so that no other file can be mistaken
                         ///< for this one
  std::string buffer_;
  std::size_t size_{0};  ///< Number of bytes written to the file so far
  hash::Sha256Hash written_;
};

}  // namespace zerocount::storage
