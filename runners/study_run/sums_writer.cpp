#include "runners/study_run/sums_writer.hpp"

#include <iterator>
#include <utility>

#include "analysis/summary/study_statistics.hpp"
#include "results/reading/statistics_file.hpp"
#include "results/shards/merge.hpp"
#include "results/shards/statistics_shard.hpp"
#include "runners/study_run/study_runner.hpp"

namespace zerocount::study_run {
namespace {

constexpr std::size_t max_bytes_of_failures = std::size_t{64} << 20;

shards::SummedTrials sum_shards(std::span<const shards::ShardInfo> shards, const study::Study& study,
                                layout::RowRange rows) {
  const bool whole = rows == layout::all_rows(study);
  summary::StudySums sums(study, statistics::summary_confidence, false,
                          whole ? summary::Collected::both : summary::Collected::sums,
                          rows.first / study.trials);
  for (const shards::ShardInfo& shard : shards)
    sums.add(reading::StatisticsFile(shard.path, reading::Require::any_part));
  summary::SummedStudy summed = sums.sum();
  shards::SummedTrials trials{std::move(summed.sums), {}, {}};
  if (!whole) return trials;
  trials.statistics =
      summary::stored_statistics(summed.points, study, summed.predictions, layout::measure_table());
  for (const measures::PointSummary& point : summed.points) {
    trials.rig_successes.push_back(point.rigs.successes_of_rigs);
    trials.rig_successes.back().resize(static_cast<std::size_t>(study.rigs));  // empty in an open loop
  }
  return trials;
}

}  // namespace

SummedBlock sum_block(const study::Study& study, TrialBlock&& block) {
  SummedBlock summed{{block.results.front().row, std::ssize(block.results)}, {}};
  for (shards::TrialResult& result : block.results) {
    const std::int64_t point = result.row / study.trials;
    if (summed.points.empty() || summed.points.back().point() != point)
      summed.points.emplace_back(study, point, result.row % study.trials);
    summed.points.back().add(result.row, result.outcome, result.jerks);
    if (study.kept == study::Kept::failures && !trial::succeeded(result.outcome.moves))
      summed.failures.push_back(std::move(result));
  }
  for (std::size_t i = 0; i < summed.points.size(); ++i) summed.points[i].add(block.predictions[i]);
  return summed;
}

SumsWriter::SumsWriter(const study::Study& study, std::filesystem::path directory)
    : study_(study), directory_(std::move(directory)), provenance_(layout::current_provenance()) {}

void SumsWriter::take(SummedBlock&& block) {
  if (block.rows.count == 0) return;
  if (waiting_ && waiting_->rows.end() != block.rows.first) flush();
  for (const shards::TrialResult& failure : block.failures) bytes_ += bytes_of(failure);
  if (waiting_) {
    append(std::move(block));
  } else {
    clock_.begin_shard();
    waiting_ = std::move(block);
  }
  if (bytes_ >= max_bytes_of_failures || waiting_->points.size() >= max_points_of_shard ||
      clock_.waited_enough())
    flush();
}

void SumsWriter::append(SummedBlock&& block) {
  waiting_->rows.count += block.rows.count;
  auto next = block.points.begin();
  if (next->point() == waiting_->points.back().point()) waiting_->points.back() += *next++;
  waiting_->points.insert(waiting_->points.end(), std::make_move_iterator(next),
                          std::make_move_iterator(block.points.end()));
  waiting_->failures.insert(waiting_->failures.end(), std::make_move_iterator(block.failures.begin()),
                            std::make_move_iterator(block.failures.end()));
}

void SumsWriter::flush() {
  if (!waiting_) return;
  std::vector<layout::PointSums> sums;
  for (const summary::SummedPoint& point : waiting_->points) sums.push_back(point.sums());
  written_.push_back({shards::shard_path(directory_, waiting_->rows), waiting_->rows});
  shards::write_statistics_shard(written_.back().path, study_, waiting_->rows, sums, waiting_->failures,
                                 provenance_);
  waiting_.reset();
  bytes_ = 0;
}

void assemble_statistics(std::span<const shards::ShardInfo> shards, const study::Study& study,
                         const std::filesystem::path& output, layout::RowRange rows) {
  const auto sums_of = [&](std::span<const shards::ShardInfo> ordered) {
    return sum_shards(ordered, study, rows);
  };
  shards::merge_statistics(shards, study, output, rows, sums_of);
}

}  // namespace zerocount::study_run
