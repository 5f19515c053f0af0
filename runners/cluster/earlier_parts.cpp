#include "runners/cluster/earlier_parts.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::cluster {

std::vector<std::int64_t> missing_parts(const std::filesystem::path& output, const study::Study& study,
                                        std::int64_t parts) {
  std::set<std::string> complete;
  const shards::ShardSurvey survey = shards::list_shards(shards::parts_directory(output), study, {});
  for (const shards::ShardInfo& part : survey.shards) complete.insert(part.path.filename().string());
  std::vector<std::int64_t> missing;
  for (std::int64_t part = 1; part <= parts; ++part)
    if (!complete.contains(shards::part_of(output, part, parts).path.filename().string()))
      missing.push_back(part);
  return missing;
}

void prepare_parts(const std::filesystem::path& output, const study::Study& study, std::int64_t parts,
                   study_run::ForeignShards foreign) {
  const layout::RowRange all = layout::all_rows(study);
  constexpr study_run::Inspection inspection = study_run::Inspection::checksum;
  study_run::earlier_shards(shards::parts_directory(output), study, all, foreign, inspection);
  for (const std::int64_t part : missing_parts(output, study, parts)) {
    const std::filesystem::path path = shards::part_of(output, part, parts).path;
    study_run::earlier_shards(layout::shards_directory(path), study, all, foreign, inspection);
  }
}

}  // namespace zerocount::cluster
