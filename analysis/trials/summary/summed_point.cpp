#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "analysis/basis/statistics/sums/state.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

bool is_possible(const theory::PointPrediction& prediction) {
  return statistics::are_counts(std::array{prediction.stable, prediction.unstable, prediction.outside},
                                prediction.trials);
}

/// Whether these counts of undecided moves are possible for this number of moves.
bool is_possible(const measures::UndecidedSums& sums, std::int64_t moves) {
  return sums.counts.moves == moves && sums.needed_holds.size <= moves &&
         std::ranges::all_of(measures::undecided_counts, [&](const measures::UndecidedCount& each) {
           return sums.counts.*each.count >= 0 && sums.counts.*each.count <= moves;
         });
}

}  // namespace

SummedPoint::SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial,
                         const layout::MeasureTable& table)
    : study_(&study), point_(point), trials_(measures::move_kind(study), table, first_trial) {}

SummedPoint::SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial)
    : SummedPoint(study, point, first_trial, layout::measure_table(study.features)) {}

void SummedPoint::add(std::span<const shards::TrialResult> trials) {
  std::vector<const trial::MoveOutcome*> moves;
  for (const shards::TrialResult& trial : trials) {
    trials_.add_counts(trial.outcome.moves, trial.jerks);
    undecided_.add(*study_, trial.row, trial.outcome.moves);
    for (const trial::MoveOutcome& move : trial.outcome.moves) moves.push_back(&move);
  }
  if (!trials.empty()) trials_.add_measures(moves, moves.size() / trials.size());
}

void SummedPoint::add_undecided(layout::RowRange rows, std::span<const trial::MoveOutcome> moves) {
  const std::size_t of_trial = moves.size() / static_cast<std::size_t>(rows.count);
  for (std::int64_t row = rows.first; row < rows.end(); ++row, moves = moves.subspan(of_trial))
    undecided_.add(*study_, row, moves.first(of_trial));
}

SummedPoint& SummedPoint::operator+=(const SummedPoint& next) {
  trials_ += next.trials_;
  undecided_ += next.undecided_;
  prediction_ = prediction_ + next.prediction_;
  return *this;
}

layout::PointSums SummedPoint::sums() const {
  statistics::State state;
  statistics::StateWriter writer(state);
  writer(undecided_, prediction_);
  const statistics::State trials = trials_.state();
  state.whole.insert(state.whole.end(), trials.whole.begin(), trials.whole.end());
  state.real.insert(state.real.end(), trials.real.begin(), trials.real.end());
  return {std::move(state.whole), std::move(state.real)};
}

void SummedPoint::restore(const layout::PointSums& sums) {
  statistics::StateReader reader(sums.whole, sums.real);
  reader(undecided_, prediction_);
  trials_.restore(reader.whole(), reader.real(), study_->moves);
  statistics::StateReader::require(prediction_.trials == trials_.trials() && is_possible(prediction_) &&
                                   is_possible(undecided_, trials_.trials() * study_->moves));
}

measures::PointSummary SummedPoint::statistics(double confidence, bool bootstrap) const {
  measures::StatisticsOptions options{confidence, {}, study_->stop.has_value()};
  if (bootstrap) options.bootstrap = {study_->seed, static_cast<std::uint32_t>(point_)};
  measures::PointSummary summary = trials_.statistics(options);
  if (undecided_.counts.moves > 0) summary.undecided = undecided_.moves();
  return summary;
}

SummedPoint restored_point(const reading::ResultsFile& file, const study::Study& study, std::int64_t point) {
  SummedPoint restored(study, point, 0);
  try {
    restored.restore(file.sums(point - file.first_point()));
    statistics::StateReader::require(restored.prediction().trials == file.rows_of(point).count);
  } catch (const Failure& failure) {
    throw Failure(failure.code(),
                  fmt::format("{}: design point {}: {}", file.path().string(), point, failure.what()));
  }
  return restored;
}

}  // namespace zerocount::summary
