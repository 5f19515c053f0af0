#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/study_run/earlier_shards.hpp"

namespace zerocount::cluster {

/// The parts of a study in `parts` parts that are not complete, in order.
std::vector<std::int64_t> missing_parts(const std::filesystem::path& output, const study::Study& study,
                                        std::int64_t parts);

/// Prepares the folder of the parts for jobs that run the missing ones: damaged parts and shards are renamed.
/// @throws Failure (bad_input) if a part, or a shard of one, is of another study or build and `refuse` is
/// given.
void prepare_parts(const std::filesystem::path& output, const study::Study& study, std::int64_t parts,
                   study_run::ForeignShards foreign);

}  // namespace zerocount::cluster
