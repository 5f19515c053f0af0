#pragma once

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"

namespace zerocount::shards {

/// Writes the realised profiles of a study to /profile: of its one rotor, or of every rig.
void write_profiles(hdf5::File& file, const study::Study& study);

/// Writes the inputs that differ between the rigs of a study to /rig.
void write_rigs(hdf5::File& file, const study::Study& study);

/// Counts the successful trials of every rig at every design point, in a file that holds all trials, and
/// writes them to /rig. A trial succeeds if all its moves end with a zero count.
void write_rig_counts(hdf5::File& file, const study::Study& study);

}  // namespace zerocount::shards
