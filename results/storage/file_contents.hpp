#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/hash/sha256.hpp"
#include "results/storage/durable_file.hpp"

/// Functions that read a file. Functions that read an open file throw Failure (machine_failed) with the path
/// and the system's reason.
namespace zerocount::storage {

/// Up to `size` bytes of a file from `offset` on, fewer if the file ends before. Empty if the file cannot be
/// read or is not a regular file; the function does not wait for a pipe, for instance.
std::string bytes_at(const std::filesystem::path& path, std::size_t offset, std::size_t size);

std::size_t size_of_file(const std::filesystem::path& path, const FileDescriptor& file);

/// Reads `bytes.size()` bytes at the current position of an open file; fewer only at its end.
/// @returns the number of bytes read.
/// @param path name of the file in error messages.
std::size_t read_some(const std::filesystem::path& path, const FileDescriptor& file,
                      std::span<std::byte> bytes);

/// Fills `bytes` from an open file, from `offset` on. Several threads can read at a time.
/// @param path name of the file in error messages.
void read_at(const std::filesystem::path& path, const FileDescriptor& file, std::uint64_t offset,
             std::span<std::byte> bytes);

/// SHA-256 of the next `length` bytes of an open file from its current position, which is behind them
/// afterwards.
/// @param path name of the file in error messages.
hash::Sha256 sha256_of(const std::filesystem::path& path, const FileDescriptor& file, std::size_t length);

/// Length of the checksum trailer in bytes: the text "zerocount-seal sha256 ", 64 hexadecimal digits and a
/// line feed.
inline constexpr std::size_t checksum_trailer_length = 22 + 64 + 1;

/// The text that is appended to a finished file, with the SHA-256 of all bytes before it. HDF5 reads the end
/// of its data from its own header and ignores the trailer.
///
/// HDF5's own checksums do not cover texts and parts of the index, and the library can crash on a damaged
/// file. Therefore the trailer is checked before the library opens a file.
std::string checksum_trailer(const hash::Sha256& checksum);

enum class ChecksumState { valid, missing, wrong };

/// Reads the whole file and compares it with the checksum in its trailer.
/// @throws Failure (machine_failed) if the file cannot be read.
ChecksumState check_checksum(const std::filesystem::path& path);

/// Checks the file with check_checksum().
/// @throws Failure: bad_data if the checksum trailer is missing or wrong, machine_failed if the file cannot
/// be read.
void require_valid_checksum(const std::filesystem::path& path);

/// Appends the checksum trailer to the closed file part_of(path) and renames it to `path`. The file must have
/// been brought to the disk, and its contents must have been read back and compared, because only the trailer
/// is read again here.
/// @param checksum checksum of these contents.
/// @throws Failure (machine_failed) with the path and the reason
void publish_compared(const std::filesystem::path& path, const hash::Sha256& checksum);

/// The SHA-256 that the trailer of a valid file records, as 64 hexadecimal digits. It identifies the
/// contents. The contents themselves are not read.
/// @throws Failure as require_valid_checksum() does for a missing trailer or an unreadable file.
std::string recorded_checksum(const std::filesystem::path& path);

}  // namespace zerocount::storage
