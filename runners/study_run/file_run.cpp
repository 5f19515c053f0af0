#include "runners/study_run/file_run.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/recorded_values.hpp"
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

namespace fs = std::filesystem;

/// The header of a results file without the last override, if this is the number of trials that a stopping
/// rule decided on. So it can be compared with the manifest's study.
layout::FileHeader as_requested(layout::FileHeader header, const study::Study& study) {
  if (study.stop && !header.overrides.empty() && header.overrides.back().starts_with(decided_key))
    header.overrides.pop_back();
  return header;
}

[[noreturn]] void refuse(const fs::path& output, std::string_view what) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}; --force replaces it, or give another name with -o",
                                                 output.string(), what));
}

layout::FileHeader header_of(const fs::path& output) {
  try {
    return reading::ResultsFile(output, reading::Require::any_part).header();
  } catch (const Failure& failure) {
    if (failure.code() == ExitCode::machine_failed) throw;  // it may be a good file
    refuse(output, fmt::format("exists, and is not a usable results file ({})", failure.what()));
  }
}

/// Checks that trials can be added to the results file `output` until it has those of the longer study.
/// @throws Failure (bad_input) if the file cannot be extended
void require_extensible(const fs::path& output, const layout::FileHeader& header, const study::Study& study) {
  const auto refuse_more = [&](std::string_view why) {
    refuse(output,
           fmt::format("has {} trials at each point and the study {}; {}", header.trials, study.trials, why));
  };
  if (!header.complete) refuse_more("a part of a study cannot be extended");
  if (layout::has_sums(study.retention))
    refuse_more("a study that does not keep its trials cannot be extended");
  if (study.trials < header.trials) refuse_more("a results file can only be extended");
  if (!study::trials_stay_when_extended(study.design)) {
    refuse_more(fmt::format("the trials of design: {} are laid out for their number, and all change with it",
                            keys::design_labels[static_cast<std::size_t>(study.design)]));
  }
  if (!layout::same_build(header.provenance, layout::current_provenance())) {
    refuse_more(
        fmt::format("its trials were run by another build ({}, commit {}), and trials of different "
                    "builds are not mixed",
                    header.provenance.zerocount_version, header.provenance.git_commit));
  }
}

}  // namespace

ExistingUse use_of_existing(const fs::path& output, const study::Study& study, layout::RowRange wanted) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(output, error))) return ExistingUse::none;
  const layout::FileHeader header = header_of(output);
  const std::vector<manifest_text::ManifestDifference> differences =
      layout::study_differences(output, as_requested(header, study), study);
  if (differences.empty()) layout::require_same_plugin(output, header, study.plugin.get());
  if (header.engine != study.engine) {
    refuse(output, fmt::format("holds the results of the {} engine, and this run is for the {} engine",
                               layout::name_of(header.engine), layout::name_of(study.engine)));
  }
  const bool other_number = differences.size() == 1 && differences.front().key == "trials";
  if (other_number && !study.stop && wanted == layout::all_rows(study)) {
    layout::require_same_plugin(output, header, study.plugin.get());
    require_extensible(output, header, study);
    return ExistingUse::extend;
  }
  if (!differences.empty())
    refuse(output, "holds the results of another study: " + manifest_text::differences_text(differences));
  if (!study.stop && !(header.rows == wanted)) {
    refuse(output, fmt::format("holds trials {} to {} of this study, and this run is for {} to {}",
                               header.rows.first, header.rows.end() - 1, wanted.first, wanted.end() - 1));
  }
  return ExistingUse::complete;
}

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
