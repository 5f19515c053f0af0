#pragma once

#include <filesystem>

#include "results/hdf5/written_values.hpp"

namespace zerocount::shards {

/// Appends the checksum trailer to the closed results file part_of(path), reads the file back from the disk,
/// and renames it to `path`.
/// @param written the expected contents
/// @throws Failure (machine_failed) if the file cannot be flushed or read, or if its contents differ.
void finish_results(const std::filesystem::path& path, const hdf5::WrittenValues& written);

}  // namespace zerocount::shards
