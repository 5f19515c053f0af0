#pragma once

#include <filesystem>
#include <functional>

#include "results/hdf5/hdf5.hpp"

namespace zerocount::testing {

/// Calls `visit` for every dataset of a results file, in order of paths.
void for_each_dataset(const std::filesystem::path& path,
                      const std::function<void(const hdf5::Dataset&)>& visit);

/// Opens a results file, a part or a shard, and reads every dataset, so that HDF5's checksums are verified.
/// @throws Failure (bad_data) for the first dataset that cannot be read
void read_everything(const std::filesystem::path& path);

/// Expects that the whole results file can be read, and that all indices of its trials are consistent.
void expect_sound(const std::filesystem::path& path);

}  // namespace zerocount::testing
