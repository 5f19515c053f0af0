#include "tests/support/merged_file.hpp"

#include "core/failure/failure.hpp"

namespace zerocount::testing {

void merge_shards(std::span<const shards::ShardInfo> shards, const study::Study& study,
                  const std::filesystem::path& output, layout::RowRange rows,
                  const StatisticsOfPoints& statistics, const shards::MergeOptions& options) {
  shards::MergedFile file(shards, study, output, rows, options);
  try {
    if (file.is_whole() && statistics) file.write_statistics(statistics(file.trials()));
  } catch (const Failure&) {
    file.require_trials();
    throw;
  }
  file.finish();
}

}  // namespace zerocount::testing
