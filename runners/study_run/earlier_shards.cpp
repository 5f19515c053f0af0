#include <cstdint>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/file_run.hpp"

namespace zerocount::study_run {
namespace {

namespace fs = std::filesystem;

/// Checks that a shard of this study was run with the controller of this study. Does nothing for shards of
/// other studies or formats.
/// @throws ForeignFile for a shard of this study that was run with another controller.
void require_same_plugin(const fs::path& shard, const study::Study& study) {
  std::optional<layout::FileHeader> header;
  try {
    header = shards::inspect_header(shard);
    if (!layout::study_differences(shard, *header, study).empty()) return;
  } catch (const Failure&) {
    return;  // another format
  }
  layout::require_same_plugin(shard, *header, study.plugin.get());
}

}  // namespace

EarlierShards choose_shards(const std::vector<shards::ShardInfo>& sound, layout::RowRange wanted) {
  EarlierShards shards;
  std::int64_t covered = wanted.first;
  for (const shards::ShardInfo& shard : sound) {
    shards.all.push_back(shard.path);
    if (shard.rows.first < covered || shard.rows.end() > wanted.end()) continue;
    covered = shard.rows.end();
    shards.usable.push_back(shard);
  }
  return shards;
}

EarlierShards earlier_shards(const fs::path& directory, const study::Study& study, layout::RowRange wanted,
                             ForeignShards foreign) {
  const shards::ShardSurvey survey = shards::list_shards(directory, study);
  for (const shards::ShardProblem& bad : survey.problems) {
    if (bad.kind == shards::ShardProblem::Kind::foreign && foreign == ForeignShards::remove) {
      std::error_code ignored;
      fs::remove(bad.path, ignored);
      continue;
    }
    if (bad.kind == shards::ShardProblem::Kind::foreign) {
      require_same_plugin(bad.path, study);
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: holds trials of another run, which this one must not touch ({}); finish that run "
                      "first, give another name with -o, or remove it with --force",
                      directory.string(), bad.problem));
    }
    fs::path aside = bad.path;
    aside += damaged_extension;
    std::error_code error;
    fs::rename(bad.path, aside, error);
    status::tell("warning: {}; its trials are run again{}\n", bad.problem,
                 error ? "" : fmt::format(", and the file is kept as {}", aside.filename().string()));
  }
  shards::remove_unfinished(survey);
  return choose_shards(survey.shards, wanted);
}

void remove_shards(const fs::path& directory, const std::vector<fs::path>& shards) {
  std::error_code error;
  for (const fs::path& shard : shards) fs::remove(shard, error);
  fs::remove(directory, error);
}

}  // namespace zerocount::study_run
