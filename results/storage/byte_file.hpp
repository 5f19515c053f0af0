#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "results/storage/durable_file.hpp"
#include "results/storage/written_bytes.hpp"

namespace zerocount::storage {

/// A failed system call on a file: what was tried, and why it failed.
struct IoFailure {
  std::string_view action;  ///< The action that failed, as a text that completes the message "cannot …"
  int error{0};             ///< Error number of the system (errno)
};

/// A file with random access that records its first failure.
///
/// The HDF5 library does not handle a failed write (see hdf5/file_driver.hpp), so it must not see one. After
/// the first failure the file on the disk is no longer changed. Later writes are kept in memory, where read()
/// finds them, so that the library can finish and free its memory. The caller checks failure() afterwards.
class ByteFile {
 public:
  enum class Mode {
    read,
    create,  ///< Creates a new, empty file; see create_file().
    change   ///< Opens an existing file to read and write.
  };

  /// Opens the file.
  /// @param so_far bytes written to the file earlier.
  /// @throws Failure (machine_failed) with the path and the system's reason if it cannot be opened.
  ByteFile(std::filesystem::path path, Mode mode, WrittenBytes so_far = {});

  const std::filesystem::path& path() const { return path_; }
  bool writable() const { return mode_ != Mode::read; }
  std::uint64_t size() const { return size_; }

  /// Reads bytes; those beyond the end of the file are 0. Returns false if reading fails.
  bool read(std::uint64_t offset, std::span<std::byte> bytes);
  void write(std::uint64_t offset, std::span<const std::byte> bytes,
             Rewritten rewritten = Rewritten::in_part);
  void resize(std::uint64_t size);
  /// Reads bytes as read() does, but does not record a failure, so that several threads can read at a time.
  /// Only for a file to which nothing has been written.
  /// @return the failure; empty on success
  std::optional<IoFailure> read_unrecorded(std::uint64_t offset, std::span<std::byte> bytes) const;
  /// Closes the file, after flushing it to the disk and dropping it from the page cache.
  void close(Flush flush = Flush::now);

  /// Records a failure that occurred elsewhere as the failure of this file, unless it has one already.
  void note(const IoFailure& failure);
  const std::optional<IoFailure>& failure() const { return failure_; }

  WrittenBytes take_written() { return std::move(written_); }

 private:
  struct Unwritten {
    std::uint64_t offset{0};
    std::vector<std::byte> bytes;
  };

  std::filesystem::path path_;
  Mode mode_;
  FileDescriptor file_;
  std::uint64_t size_{0};
  WrittenBytes written_;
  std::optional<IoFailure> failure_;
  std::vector<Unwritten> unwritten_;  ///< Bytes that could not be written, in the order of the write calls
};

}  // namespace zerocount::storage
