#pragma once

#include <functional>

#include "results/hdf5/hdf5.hpp"

namespace zerocount {

/// Calls `visit` for every dataset below `group`, in order of creation.
void for_each_dataset(const hdf5::Group& group, const std::function<void(const hdf5::Dataset&)>& visit);

/// Reads every dataset below `group`, in blocks, so that HDF5's checksums are compared.
/// @throws Failure (bad_data) for the first that does not read.
void read_everything(const hdf5::Group& group);

}  // namespace zerocount
