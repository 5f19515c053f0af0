#pragma once

#include <cstdint>

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/groupings.hpp"
#include "results/layout/layout.hpp"

/// The tables of a results file that describe its study, not its trials.
namespace zerocount::shards {

/// Writes the realised profiles of a study to /profile: of its one rotor, or of every machine.
void write_profiles(hdf5::File& file, const study::Study& study);

/// Writes the data of the groups of a grouping: the inputs of machines and worlds, names of conditions, ages.
/// Writes nothing if the study has no such groups.
void write_groups(hdf5::File& file, const study::Study& study, const layout::Grouping& grouping);

/// Writes the counts of consecutive design points. The call for the first points creates the datasets.
/// @param first number of the first point
void write_group_counts(hdf5::File& file, const study::Study& study, const layout::Grouping& grouping,
                        const layout::GroupCounts& counts, std::int64_t first);

}  // namespace zerocount::shards
