#pragma once

#include <cstdint>
#include <vector>

#include "experiments/study/study_fwd.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::shards {

/// Writes the realised profiles of a study to /profile: of its one rotor, or of every rig.
void write_profiles(hdf5::File& file, const study::Study& study);

/// Writes the inputs that differ between the rigs of a study to /rig.
void write_rigs(hdf5::File& file, const study::Study& study);

/// Writes the trials that were judged and those that succeeded at the points from `first` on to /rig.
/// @param successes [point][rig]
void write_rig_counts(hdf5::File& file, const study::Study& study,
                      const std::vector<std::vector<std::int64_t>>& successes, std::int64_t first);

/// Writes the inputs that differ between the worlds of a study to /world.
void write_worlds(hdf5::File& file, const study::Study& study);

/// Writes the trials of the worlds at the points from `first` on to /world.
void write_world_counts(hdf5::File& file, const study::Study& study, const layout::GroupCounts& counts,
                        std::int64_t first);

/// Writes the names of the conditions of a study to /condition.
void write_conditions(hdf5::File& file, const study::Study& study);

/// Writes the trials under the conditions at the points from `first` on to /condition.
void write_condition_counts(hdf5::File& file, const study::Study& study, const layout::GroupCounts& counts,
                            std::int64_t first);

/// Writes the ages of a study to /age.
void write_ages(hdf5::File& file, const study::Study& study);

/// Writes the trials and machines at the ages at the points from `first` on to /age, and the lives of the
/// rigs to /rig.
void write_age_counts(hdf5::File& file, const study::Study& study, const layout::AgeCounts& counts,
                      std::int64_t first);

}  // namespace zerocount::shards
