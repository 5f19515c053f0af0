#include "runners/study_run/file_run.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/trials/study_runner.hpp"

namespace zerocount::study_run {
namespace {

constexpr std::int64_t max_moves_at_once = 1 << 16;

/// Copies trials of a finished results file to shards (files with trials) of a study that differs only in
/// having more trials. Memory is bounded.
/// @param missing rows of the study (numbers of its trials) that are not in shards yet; of these, the ones in
/// the file are copied
/// @returns the written shards, in order of rows
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

/// Makes the folder of the shards, the files with the trials of a running study.
/// @returns the usable shards that exist before the first trial is run
EarlierShards prepare_shards(const FileRun& request, const std::filesystem::path& directory,
                             ExistingUse existing) {
  EarlierShards earlier = earlier_shards(directory, request.study, request.wanted, request.foreign);
  const std::int64_t missing = layout::total_rows(shards::missing_ranges(earlier.usable, request.wanted));
  if (request.check_room) forecast::require_room(request.output, request.study, missing);
  storage::make_directory(directory);
  if (existing != ExistingUse::extend) return earlier;
  const reading::AllTrialsFile file(request.output);
  if (!request.quiet) {
    status::tell("{}: {} trials at each point are kept, {} are added\n", request.output.string(),
                 file.header().trials, request.study.trials - file.header().trials);
  }
  const std::vector<layout::RowRange> ranges = shards::missing_ranges(earlier.usable, request.wanted);
  for (shards::ShardInfo& shard : copy_trials(file, request.study, directory, ranges)) {
    earlier.all.push_back(shard.path);
    earlier.usable.push_back(std::move(shard));
  }
  return earlier;
}

}  // namespace

void run_to_file(const FileRun& request, ExistingUse existing, const std::stop_token& stop) {
  const std::filesystem::path directory = layout::shards_directory(request.output);
  EarlierShards earlier = prepare_shards(request, directory, existing);
  const layout::RowRange wanted = request.wanted;
  const std::vector<layout::RowRange> missing = shards::missing_ranges(earlier.usable, wanted);
  const std::int64_t kept = wanted.count - layout::total_rows(missing);

  status::Progress progress(wanted.count, kept, trials::samples_per_trial(request.study), request.quiet,
                            request.listener);
  std::int64_t done = kept;
  trials::RunSettings settings;
  settings.threads = request.threads;
  settings.timeline = request.timeline;
  settings.finished = [&](std::int64_t trials) { progress.update(done += trials); };
  const trials::FinishedTrials finished =
      trials::run_trials(request.study, missing, directory, settings, stop);
  progress.finish(done);

  if (done < wanted.count) {
    throw Failure(
        ExitCode::interrupted,
        fmt::format("interrupted: {} of {} trials are kept in {}; give the same command again to continue",
                    done, wanted.count, directory.string()));
  }
  std::vector<shards::ShardInfo> shards = std::move(earlier.usable);
  shards.insert(shards.end(), finished.shards.begin(), finished.shards.end());
  shards::sort_by_rows(shards);
  assemble(shards, request.study, request.output, wanted,
           {.predictions = finished.predictions, .stop = stop, .timeline = request.timeline});
  for (const shards::ShardInfo& shard : finished.shards) earlier.all.push_back(shard.path);
  remove_shards(directory, earlier.all);
  if (!request.quiet) status::tell("wrote {}\n", request.output.string());
}

}  // namespace zerocount::study_run
