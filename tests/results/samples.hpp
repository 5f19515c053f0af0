#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/shards/merge.hpp"
#include "results/shards/shard.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {

/// A made-up study with two sweep axes (numbers and a case), two inputs, one profile and one retained trial
/// whose record has all existing columns. The text of its manifest is arbitrary, because nothing reads it.
study::Study sample_study(std::int64_t points = 3, std::int64_t trials = 40, std::int64_t moves = 2);

/// A sample study on 8 machines, with one input and one rotor drawn for each machine.
study::Study sample_study_with_machines(std::int64_t points = 3, std::int64_t trials = 40,
                                        std::int64_t moves = 2);

/// The random result of the trial in a row of the results, always the same for the same row. Some trials have
/// no jerks, some many.
shards::TrialResult sample_result(const study::Study& study, std::int64_t row);
std::vector<shards::TrialResult> sample_results(const study::Study& study, layout::RowRange rows);

/// [input column] the inputs of the trial in a row of the file.
std::vector<double> inputs_of(const reading::AllTrialsFile& file, std::int64_t row);

/// A provenance that is equal in every call, so that whole files can be compared.
layout::Provenance sample_provenance();

/// Writes one shard (a file with the results of these rows) into `directory`.
shards::ShardInfo write_sample_shard(const std::filesystem::path& directory, const study::Study& study,
                                     layout::RowRange rows);

/// Writes the shards of `rows` cut into pieces of `size` rows.
std::vector<shards::ShardInfo> write_sample_shards(const std::filesystem::path& directory,
                                                   const study::Study& study, layout::RowRange rows,
                                                   std::int64_t size);

/// Statistics computed from the file: the number of trials per point, the mean settling time of the first
/// move, and sample_table.
layout::StoredStatistics sample_statistics(const reading::AllTrialsFile& file);
layout::StatisticTable sample_table(const reading::AllTrialsFile& file);

/// Writes a complete results file of the study by merging shards of `size` rows.
std::filesystem::path write_sample_file(const std::filesystem::path& directory, const study::Study& study,
                                        std::int64_t size = 17);

/// A made-up study with seven worlds (possible sets of the values that all machines share). Of the 40 trials
/// at a design point, five worlds have six each and two have five each.
study::Study sample_study_in_worlds();

/// Counts of the trials in the file for each world. A trial counts as meeting the goal if its first move
/// arrived.
layout::GroupCounts counted_worlds(const reading::AllTrialsFile& file, std::int64_t worlds);

/// Writes a results file of a study with worlds. Conditions, if there are any, are counted like worlds. A
/// trial counts as meeting the goal if its first move arrived.
/// @param size number of trials of a shard
std::filesystem::path write_file_in_worlds(const std::filesystem::path& directory, const study::Study& study,
                                           bool has_goal = true, std::int64_t size = 17);

}  // namespace zerocount::testing
