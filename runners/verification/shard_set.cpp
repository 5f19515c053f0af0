#include "runners/verification/shard_set.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/shards/shard.hpp"

namespace zerocount::verification {
namespace {

/// The study hash of most shards; of several that are as frequent, the first of the folder.
std::string common_study(std::span<const ShardHeader> shards) {
  std::map<std::string, std::int64_t> counts;
  for (const ShardHeader& shard : shards) ++counts[shard.header.study_sha256];
  const auto fewer = [&](const ShardHeader& one, const ShardHeader& other) {
    return counts[one.header.study_sha256] < counts[other.header.study_sha256];
  };
  return std::max_element(shards.begin(), shards.end(), fewer)->header.study_sha256;
}

/// The first reason why the shard cannot be of one run with `first`; empty if it can.
std::string stranger(const layout::FileHeader& shard, const layout::FileHeader& first) {
  if (shard.study_sha256 != first.study_sha256)
    return fmt::format("of another study ('{}') than most", shard.name);
  if (!layout::same_build(shard.provenance, first.provenance))
    return fmt::format("of another build ({}, commit {})", shard.provenance.zerocount_version,
                       shard.provenance.git_commit);
  if (shard.engine != first.engine) return fmt::format("of the {} engine", layout::name_of(shard.engine));
  if (shard.version != first.version) return fmt::format("of format version {}", shard.version);
  return {};
}

void check_overlaps(std::span<const shards::ShardInfo> sorted, ProblemList& problems) {
  const shards::ShardInfo* furthest = nullptr;
  for (const shards::ShardInfo& shard : sorted) {
    if (furthest != nullptr && shard.rows.first < furthest->rows.end()) {
      problems.add(fmt::format("{} holds trials {} to {}, which overlap those of {}",
                               shard.path.filename().string(), shard.rows.first, shard.rows.end() - 1,
                               furthest->path.filename().string()));
    }
    if (furthest == nullptr || shard.rows.end() > furthest->rows.end()) furthest = &shard;
  }
}

/// A run that goes on, or was interrupted, has not run all trials yet.
Check unfinished(std::span<const layout::RowRange> gaps) {
  return {.name = "all trials",
          .detail = fmt::format("{} are in none of the shards yet, from trial {} on",
                                layout::total_rows(gaps), gaps.front().first),
          .skipped = true};
}

}  // namespace

void check_shard_set(CheckReport& report, std::span<const ShardHeader> shards, bool stops) {
  std::vector<layout::RowRange> gaps;
  add_check(report, "shards", [&](Check& check, ProblemList& problems) {
    const std::string study = common_study(shards);
    const layout::FileHeader& first =
        std::find_if(shards.begin(), shards.end(), [&](const ShardHeader& shard) {
          return shard.header.study_sha256 == study;
        })->header;
    std::vector<shards::ShardInfo> own;
    for (const ShardHeader& shard : shards) {
      const std::string strange = stranger(shard.header, first);
      if (strange.empty()) own.push_back({shard.path, shard.header.rows});
      if (!strange.empty()) problems.add(fmt::format("{} is {}", shard.path.filename().string(), strange));
    }
    shards::sort_by_rows(own);
    check_overlaps(own, problems);
    check.detail = fmt::format("{} of one study{}", own.size(), stops ? "" : ", with each trial once");
    if (!stops) gaps = shards::missing_ranges(own, {0, first.trials * first.points});
  });
  if (!gaps.empty()) report.checks.push_back(unfinished(gaps));
}

}  // namespace zerocount::verification
