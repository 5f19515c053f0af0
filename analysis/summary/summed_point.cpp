#include "analysis/summary/summed_point.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/state.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

bool is_possible(const theory::PointPrediction& prediction) {
  return statistics::are_counts(std::array{prediction.stable, prediction.unstable, prediction.outside},
                                prediction.trials);
}

/// Whether the counts are possible for this number of moves.
bool is_possible(const UndecidedSums& sums, std::int64_t moves) {
  return sums.counts.moves == moves && sums.needed_holds.size <= moves &&
         std::ranges::all_of(measures::undecided_counts, [&](const measures::UndecidedCount& each) {
           return sums.counts.*each.count >= 0 && sums.counts.*each.count <= moves;
         });
}

}  // namespace

SummedPoint::SummedPoint(const study::Study& study, std::int64_t point, std::int64_t first_trial)
    : study_(&study),
      point_(point),
      trials_(measures::move_kind(study), layout::measure_table(study.features.bands), first_trial) {}

void SummedPoint::add(std::int64_t row, const trial::TrialOutcome& outcome,
                      std::span<const trial::Jerk> jerks) {
  trials_.add(outcome, jerks);
  undecided_.add(*study_, row, outcome.moves);
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
  return trials_.statistics(options);
}

StudySums::StudySums(const study::Study& study, double confidence, bool bootstrap, Collected collected,
                     std::int64_t first_point)
    : study_(study),
      confidence_(confidence),
      bootstrap_(bootstrap),
      collected_(collected),
      next_point_(first_point) {
  statistics::require_confidence(confidence);
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

void StudySums::add(const reading::ResultsFile& file, std::int64_t point) {
  const SummedPoint added = restored_point(file, study_, point);
  while (!point_ || point_->point() < point) begin_point();
  *point_ += added;
}

void StudySums::add(const reading::ResultsFile& file) {
  for (std::int64_t i = 0; i < file.points(); ++i) add(file, file.first_point() + i);
}

void StudySums::begin_point() {
  if (point_) end_point();
  point_.emplace(study_, next_point_++, 0);
}

void StudySums::end_point() {
  if (collected_ != Collected::sums) add_statistics();
  if (collected_ != Collected::statistics) sum_.sums.push_back(point_->sums());
  point_.reset();
}

void StudySums::add_statistics() {
  try {
    sum_.points.push_back(point_->statistics(confidence_, bootstrap_));
  } catch (const std::logic_error& error) {  // of a formula whose arguments no trials give
    throw Failure(ExitCode::bad_data,
                  fmt::format("design point {}: no statistics follow from its sums, which are damaged ({})",
                              point_->point(), error.what()));
  }
  sum_.predictions.push_back(point_->prediction());
  sum_.undecided.push_back(point_->undecided());
}

SummedStudy StudySums::sum() {
  if (point_) end_point();
  return std::move(sum_);
}

}  // namespace zerocount::summary
