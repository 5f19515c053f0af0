#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/hash/sha256.hpp"

namespace zerocount::storage {

/// Length of the checksum trailer in bytes: the text "zerocount-seal sha256 ", 64 hexadecimal digits and a
/// line feed.
inline constexpr std::size_t checksum_trailer_length = 22 + 64 + 1;

/// The trailer of contents with this checksum.
std::string checksum_trailer(const hash::Sha256& checksum);

/// Appends the checksum trailer, the SHA-256 of all bytes before it, to a finished file and flushes the file
/// to the disk. HDF5 reads the end of its data from its own header and ignores the trailer.
///
/// HDF5's own
/// checksums do not cover texts and parts of the index, and the library can crash on a damaged file.
/// Therefore the trailer is checked before the library opens a file.
/// @throws Failure (machine_failed) with the path and the reason
void append_checksum(const std::filesystem::path& path);

enum class ChecksumState { valid, missing, wrong };

/// Reads the whole file and compares it with its checksum trailer.
/// @throws Failure (machine_failed) if the file cannot be read.
ChecksumState check_checksum(const std::filesystem::path& path);

/// Calls check_checksum() and throws unless the file is valid.
/// @throws Failure: bad_data if the checksum trailer is missing or wrong, machine_failed if the file cannot
/// be read.
void require_valid_checksum(const std::filesystem::path& path);

/// Appends the checksum trailer to the closed file part_of(path), which was brought to the disk and whose
/// contents came from there and were as they should be, so that only the trailer is read again; renames it to
/// `path`.
/// @param checksum of these contents
/// @throws Failure (machine_failed) with the path and the reason
void publish_compared(const std::filesystem::path& path, const hash::Sha256& checksum);

/// The SHA-256 that the trailer of a valid file records, 64 hexadecimal digits: it identifies the contents.
/// @throws Failure as require_valid_checksum, without reading more than the trailer.
std::string recorded_checksum(const std::filesystem::path& path);

}  // namespace zerocount::storage
