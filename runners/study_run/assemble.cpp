#include "runners/study_run/assemble.hpp"

#include "analysis/summary/study_statistics.hpp"
#include "results/shards/merge.hpp"

namespace zerocount {

void assemble(std::span<const ShardInfo> shards, const Study& study, const std::filesystem::path& output,
              RowRange rows, const Renumbering& renumber) {
  const auto statistics = [&](const StudyFile& file) { return stored_statistics(file, study); };
  merge_shards(shards, study, output, rows, statistics, current_provenance(), renumber);
}

}  // namespace zerocount
