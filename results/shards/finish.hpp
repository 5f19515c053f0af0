#pragma once

#include <filesystem>

#include "results/hdf5/written_values.hpp"

namespace zerocount {

/// Seals the closed results file part_of(path), reads all of it back from the disk, and gives it its name
/// `path`.
/// @param written what it must hold
/// @throws Failure (machine_failed) where it cannot be brought to the disk or read, or holds anything else.
void finish_results(const std::filesystem::path& path, const hdf5::WrittenValues& written);

}  // namespace zerocount
