#pragma once

#include <cstddef>
#include <filesystem>

namespace zerocount {

/// Length of the seal in bytes: the text "zerocount-seal sha256 ", 64 hexadecimal digits and a line feed.
inline constexpr std::size_t checksum_trailer_length = 22 + 64 + 1;

/// Appends the seal to a finished file: the SHA-256 of everything before it. HDF5 ends where its own header
/// says, and takes no notice of what follows.
///
/// HDF5's checksums do not reach texts and parts of its index, and the library can crash on a damaged file.
/// The seal is checked before the library sees a file. The sealed file is on the disk.
/// @throws Failure (machine_failed) with the path and the reason
void append_checksum(const std::filesystem::path& path);

enum class ChecksumState { valid, missing, wrong };

/// Reads the file once from beginning to end, and compares it with its seal.
/// @throws Failure (machine_failed) where the file cannot be read.
ChecksumState check_checksum(const std::filesystem::path& path);

/// check_checksum, for a file that must be sound.
/// @throws Failure: bad_data where the seal is missing or wrong, machine_failed where the file cannot be
/// read.
void require_valid_checksum(const std::filesystem::path& path);

}  // namespace zerocount
