#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/hash/sha256.hpp"
#include "results/storage/file_descriptor.hpp"

/// Functions that read a file. Those that read an open one throw Failure (machine_failed) with the path and
/// the system's reason.
namespace zerocount::storage {

/// Up to `size` bytes of a file from `offset` on, fewer at its end. Empty if it cannot be read or is no
/// regular file; a pipe, say, is not waited for.
std::string bytes_at(const std::filesystem::path& path, std::size_t offset, std::size_t size);

std::size_t size_of_file(const std::filesystem::path& path, const FileDescriptor& file);

/// Reads `bytes.size()` bytes at the file position; fewer only at the end of the file.
std::size_t read_some(const std::filesystem::path& path, const FileDescriptor& file,
                      std::span<std::byte> bytes);

/// Reads all of `bytes`, from `offset` on. Several threads can read at a time.
void read_at(const std::filesystem::path& path, const FileDescriptor& file, std::uint64_t offset,
             std::span<std::byte> bytes);

/// SHA-256 of the next `length` bytes of the file. The file position is behind them afterwards.
hash::Sha256 sha256_of(const std::filesystem::path& path, const FileDescriptor& file, std::size_t length);

}  // namespace zerocount::storage
