#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/shards/merge.hpp"
#include "results/shards/shard.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {

/// A study with two sweep axes (numbers and a case), two inputs, one profile and one retained trial whose
/// record has all columns that there are. Nothing reads its manifest, which is any text.
Study sample_study(std::int64_t points = 3, std::int64_t trials = 40, std::int64_t moves = 2);

/// The same on 8 rigs, with one input that is drawn for each, and a rotor for each.
Study sample_study_with_rigs(std::int64_t points = 3, std::int64_t trials = 40, std::int64_t moves = 2);

/// Some result of a row: random, a function of the row alone. Some trials have no jerks, some many.
TrialResult sample_result(const Study& study, std::int64_t row);
std::vector<TrialResult> sample_results(const Study& study, RowRange rows);

/// The same for every call, so that whole files can be compared.
Provenance sample_provenance();

/// Writes one shard into `directory`.
ShardInfo write_sample_shard(const std::filesystem::path& directory, const Study& study, RowRange rows);

/// Writes the shards of `rows` cut into pieces of `size` rows.
std::vector<ShardInfo> write_sample_shards(const std::filesystem::path& directory, const Study& study,
                                           RowRange rows, std::int64_t size);

/// Two statistics, computed from the file: trials per point, and the mean settling time of the first move;
/// and sample_table.
StoredStatistics sample_statistics(const StudyFile& file);
StatisticTable sample_table(const StudyFile& file);

/// A whole results file of the study, by way of shards of `size` rows.
std::filesystem::path write_sample_file(const std::filesystem::path& directory, const Study& study,
                                        std::int64_t size = 17);

}  // namespace zerocount::testing
