#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/trials/iso230/results_group.hpp"
#include "analysis/trials/summary/stored_statistics.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "core/failure/failure.hpp"
#include "results/shards/merge.hpp"
#include "runners/study_run/file_run.hpp"

namespace zerocount::study_run {
namespace {

/// Writes the sums of the shards, for a study that does not keep its trials. If the file has the whole study,
/// also writes the statistics that follow from these sums.
void write_summed(shards::MergedFile& file, const study::Study& study, layout::RowRange rows,
                  const std::stop_token& stop) {
  std::vector<layout::PointSums> sums;
  std::vector<measures::PointSummary> points;
  std::vector<theory::PointPrediction> predictions;
  summary::StudyAccumulator accumulator(
      study,
      {.statistics = file.is_whole(), .sums = true, .first_point = rows.first / study.trials, .stop = stop},
      [&](summary::PointResults&& point) {
        sums.push_back(std::move(point.sums));
        predictions.push_back(point.prediction);
        if (file.is_whole()) points.push_back(std::move(point.statistics));
      });
  for (const shards::ShardInfo& shard : file.shards())
    accumulator.add(reading::ResultsFile(shard.path, reading::Require::any_part, nullptr, &study));
  accumulator.finish();
  file.write_sums(sums);
  if (!file.is_whole()) return;
  file.write_statistics(
      summary::stored_statistics(points, study, predictions, layout::measure_table(study.features)));
}

/// Writes the statistics that follow from all trials in the file, for a study that keeps them.
void write_statistics(shards::MergedFile& file, const study::Study& study, const AssembleSettings& settings) {
  try {
    summary::take_stored_statistics(
        file.trials(), study, settings.predictions,
        [&](const layout::StoredStatistics& block) { file.write_statistics(block); },
        {settings.timeline, settings.stop});
    if (!study.sequence.empty()) iso230::write_repeatability(file.file(), study);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::interrupted) file.require_trials();
    throw;
  }
}

}  // namespace

void assemble(std::span<const shards::ShardInfo> shards, const study::Study& study,
              const std::filesystem::path& output, layout::RowRange rows, const AssembleSettings& settings) {
  const auto timed = [&](std::string_view name, const auto& work) {
    const timeline::TimeSpan span(settings.timeline, name, timeline::Work::serial, rows.count);
    work();
  };
  std::optional<shards::MergedFile> file;
  timed("merge", [&] {
    file.emplace(shards, study, output, rows,
                 shards::MergeOptions{
                     .renumber = settings.renumber, .stop = settings.stop, .timeline = settings.timeline});
  });
  if (layout::has_sums(study.retention)) {
    timed("statistics", [&] { write_summed(*file, study, rows, settings.stop); });
  } else if (file->is_whole()) {
    write_statistics(*file, study, settings);
  }
  timed("store", [&] { file->close(); });
  timed("read back", [&] { file->read_back(); });
  timed("publish", [&] { file->publish(); });
}

}  // namespace zerocount::study_run
