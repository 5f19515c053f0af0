#pragma once

#include <filesystem>

#include "results/hdf5/hdf5.hpp"

namespace zerocount::hdf5 {

/// Opens a file that someone else may have made, to read. Before, a child process reads its objects,
/// attributes, texts and the first element of each dataset: the HDF5 library crashes on some files that were
/// damaged on purpose, and then only the child ends. Takes about 20 ms, and 0.15 s for a study with 300 000
/// design points.
/// @throws Failure: bad_data if the child crashes or takes more than 20 s of processor time, or the file is
/// damaged; machine_failed if there can be no child, it is killed or takes more than 120 s, or the file
/// cannot be read.
File open_foreign(const std::filesystem::path& path);

}  // namespace zerocount::hdf5
