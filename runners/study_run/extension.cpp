#include "runners/study_run/extension.hpp"

#include <algorithm>
#include <cstdint>

#include "runners/study_run/recorded_trials.hpp"

namespace zerocount::study_run {
namespace {

constexpr std::int64_t max_moves_at_once = 1 << 16;

}  // namespace

std::vector<shards::ShardInfo> copy_trials(const reading::AllTrialsFile& file, const study::Study& study,
                                           const std::filesystem::path& directory,
                                           std::span<const layout::RowRange> missing) {
  const RecordPlaces records = places_of_records(*file.trials());
  const std::int64_t trials = file.header().trials;
  const std::int64_t at_once = std::max<std::int64_t>(max_moves_at_once / study.moves, 1);
  std::vector<shards::ShardInfo> written;
  for (const layout::RowRange& range : missing) {
    for (std::int64_t row = range.first; row < range.end();) {
      const std::int64_t point = row / study.trials;
      const std::int64_t index = row % study.trials;
      const std::int64_t count = std::min({trials - index, range.end() - row, at_once});
      if (count <= 0) {  // beyond the file's trials of this point
        row = (point + 1) * study.trials;
        continue;
      }
      written.push_back({shards::shard_path(directory, {row, count}), {row, count}});
      shards::write_shard(written.back().path, study, {row, count},
                          read_trials(*file.trials(), {point * trials + index, count}, row, records), {},
                          {file.header().provenance});
      row += count;
    }
  }
  return written;
}

}  // namespace zerocount::study_run
