#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "results/storage/file_descriptor.hpp"

namespace zerocount {

/// What a system call failed to do, and why.
struct IoFailure {
  std::string_view action;  ///< completes "cannot …"
  int error{0};             ///< the system's error number (errno)
};

/// A file that is read and written at any offset, and remembers the first operation that failed.
///
/// It serves a library that cannot be told of a failed write (see hdf5/file_driver.hpp). After the first
/// failure the file on the disk is left alone: what is written then is kept in memory, where read() finds it,
/// so that the library can finish and free what it holds. The caller asks for failure() afterwards.
class ByteFile {
 public:
  enum class Mode {
    read,
    create,  ///< new and empty; what stood there is lost
    change   ///< of an existing file
  };

  /// @throws Failure (machine_failed) with the path and the system's reason where it cannot be opened.
  ByteFile(std::filesystem::path path, Mode mode);

  const std::filesystem::path& path() const { return path_; }
  bool writable() const { return mode_ != Mode::read; }
  std::uint64_t size() const { return size_; }

  /// Bytes beyond the end of the file are 0. False where they cannot be read.
  bool read(std::uint64_t offset, std::span<std::byte> bytes);
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  void resize(std::uint64_t size);
  /// Brings what was written to the disk and closes the file.
  void close();

  /// Remembers a failure from elsewhere, unless there was one before.
  void note(const IoFailure& failure);
  const std::optional<IoFailure>& failure() const { return failure_; }

 private:
  struct Unwritten {
    std::uint64_t offset{0};
    std::vector<std::byte> bytes;
  };

  std::filesystem::path path_;
  Mode mode_;
  FileDescriptor file_;
  std::uint64_t size_{0};
  std::optional<IoFailure> failure_;
  std::vector<Unwritten> unwritten_;  ///< in the order in which they were to be written
};

}  // namespace zerocount
