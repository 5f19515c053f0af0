#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::testing {

/// A study with a sequence of moves: two points with different encoders, random targets and phases.
/// @param sequence further keys of command.sequence, as "cycles: 3, approach: positive"
/// @param more lines of the manifest
study::Study sequence_study(const std::string& sequence = "cycles: 3", std::int64_t trials = 80,
                            const std::string& more = "");

/// [row] made-up results of the trials of a sequence study. Moves end a count or two from their targets; in
/// every seventh trial they end in the middle of the target's count. The final error is what the encoder
/// reads at the end position.
std::vector<shards::TrialResult> sequence_results(const study::Study& study);

/// Writes a complete results file of the study.
void write_sequence_file(const std::filesystem::path& path, const study::Study& study,
                         const std::vector<shards::TrialResult>& results);

}  // namespace zerocount::testing
