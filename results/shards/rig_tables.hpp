#pragma once

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"

namespace zerocount {

/// Writes what differs between the rigs of a study to /rig.
void write_rigs(hdf5::File& file, const Study& study);

/// Counts, in a file that holds all trials of the study, how many of every rig succeeded at every design
/// point, and writes that to /rig. A trial succeeds where all its moves end with a zero count.
void write_rig_counts(hdf5::File& file, const Study& study);

}  // namespace zerocount
