#pragma once

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"

namespace zerocount::shards {

/// Writes the realised profiles of a study to /profile: of its one rotor, or of every rig.
void write_profiles(hdf5::File& file, const study::Study& study);

}  // namespace zerocount::shards
