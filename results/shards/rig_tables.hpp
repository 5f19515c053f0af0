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

/// Writes the trials that were judged and those that succeeded to /rig. @param successes [point][rig]
void write_rig_counts(hdf5::File& file, const study::Study& study,
                      const std::vector<std::vector<std::int64_t>>& successes);

}  // namespace zerocount::shards
