#pragma once

#include <cstdint>

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/groupings.hpp"
#include "results/layout/layout.hpp"

/// The tables of a results file that describe its study, not its trials.
namespace zerocount::shards {

/// Writes the friction profiles of a study, as drawn for its one rotor or for every machine, to /profile.
void write_profiles(hdf5::File& file, const study::Study& study);

/// Writes the data of the groups of a grouping of trials: the inputs of machines and worlds (draws of what
/// all machines share), the names of conditions, or the ages. Writes nothing if the study has no such groups.
void write_groups(hdf5::File& file, const study::Study& study, const layout::Grouping& grouping);

/// Writes the counts of trials in the groups of a grouping, for consecutive design points. The call for the
/// first points creates the datasets.
/// @param first index of the first of these points
void write_group_counts(hdf5::File& file, const study::Study& study, const layout::Grouping& grouping,
                        const layout::GroupCounts& counts, std::int64_t first);

}  // namespace zerocount::shards
