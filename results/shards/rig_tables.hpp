#pragma once

#include <cstdint>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"

namespace zerocount::shards {

/// Writes the realised profiles of a study to /profile: of its one rotor, or of every rig.
void write_profiles(hdf5::File& file, const study::Study& study);

/// Writes the inputs that differ between the rigs of a study to /rig.
void write_rigs(hdf5::File& file, const study::Study& study);

/// Successful trials, [point][rig]. A trial succeeds if all its moves end with a zero count.
using RigSuccesses = std::vector<std::vector<std::int64_t>>;

/// Counts them in a file that holds all trials.
RigSuccesses count_rig_successes(const hdf5::File& file, const study::Study& study);

/// Writes them to /rig, beside the trials that were judged.
void write_rig_counts(hdf5::File& file, const study::Study& study, const RigSuccesses& successes);

}  // namespace zerocount::shards
