#include "runners/study_run/assemble.hpp"

#include "analysis/summary/study_statistics.hpp"
#include "results/shards/merge.hpp"

namespace zerocount::study_run {

void assemble(std::span<const shards::ShardInfo> shards, const study::Study& study,
              const std::filesystem::path& output, layout::RowRange rows,
              const shards::Renumbering& renumber) {
  const auto statistics = [&](const reading::StudyFile& file) {
    return summary::stored_statistics(file, study);
  };
  shards::merge_shards(shards, study, output, rows, statistics, layout::current_provenance(), renumber);
}

}  // namespace zerocount::study_run
