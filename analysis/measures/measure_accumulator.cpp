#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "analysis/measures/point_accumulator.hpp"
#include "analysis/measures/trial_value.hpp"
#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/statistics/mean_bounds.hpp"
#include "core/trial/divergence.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::measures {
namespace {

bool needs_every_value(const layout::Measure& measure, const layout::ReportedStatistics& reported) {
  return measure.of_trial == layout::OfTrial::sum || reports(reported, layout::Statistic::median) ||
         reports(reported, layout::Statistic::p95);
}

/// Whether files of this version have the measure, or a known value in place of it.
bool is_known(const layout::Measure& measure, std::int64_t version) {
  return measure.file.since <= version || !std::isnan(measure.file.before);
}

}  // namespace

MeasureAccumulator::MeasureAccumulator(const layout::Measure& measure,
                                       const layout::ReportedStatistics& reported, const MoveKind& kind)
    : measure_(&measure),
      reported_(&reported),
      kind_(kind),
      in_clusters_(needs_every_value(measure, reported)),
      clusters_(kind.rigs),
      hits_(static_cast<std::size_t>(std::max<std::int64_t>(kind.rigs, 1))) {}

void MeasureAccumulator::add_quality(std::span<const trial::MoveOutcome> moves) {
  by_move_.resize(moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) by_move_[i] += layout::has_quality(*measure_, moves[i]);
  hits_[static_cast<std::size_t>(trials_) % hits_.size()] += value_of_trial(*measure_, moves) > 0.0;
}

/// Adds values_ to the clusters, with `size` − |values_| censored values: later than all others.
void MeasureAccumulator::add_clusters(std::int64_t size) {
  if (reports(*reported_, layout::Statistic::bootstrap_low)) {
    totals_.add(kind_.rigs > 0 ? trials_ % kind_.rigs : trials_,
                std::accumulate(values_.begin(), values_.end(), 0.0), static_cast<double>(values_.size()));
  }
  clusters_.add_trial(trials_, values_, size);
}

void MeasureAccumulator::add(std::span<const trial::MoveOutcome> moves) {
  if (reported_->texts.empty()) return;
  values_.clear();
  const layout::CountedValues& counted = measure_->values;
  if (layout::is_quality(*measure_)) {
    add_quality(moves);
  } else if (measure_->of_trial == layout::OfTrial::sum) {
    values_.push_back(value_of_trial(*measure_, moves));
    add_clusters(1);
  } else if (!(counted.needs_target && kind_.open_loop)) {
    const bool known = is_known(*measure_, kind_.version);
    for (const trial::MoveOutcome& move : moves) {
      const double value = known ? counted_value(*measure_, move) : statistics::unknown;
      if (!in_clusters_ && trial::was_run(move)) moments_.add(value);
      if (in_clusters_ && !std::isnan(value)) values_.push_back(value);
    }
    if (in_clusters_) add_clusters(counted.nan_is_late ? std::ssize(moves) : std::ssize(values_));
  }
  ++trials_;
}

RateWithBounds MeasureAccumulator::rate(double confidence) const {
  if (trials_ == 0 || kind_.open_loop) return {};
  if (kind_.rigs == 0) {
    return {zerocount::statistics::rate(hits_.front(), trials_),
            statistics::clopper_pearson(hits_.front(), trials_, confidence),
            statistics::wilson(hits_.front(), trials_, confidence)};
  }
  statistics::ClusterSums sums;
  for (std::int64_t rig = 0; rig < kind_.rigs; ++rig) {
    sums.add(hits_[static_cast<std::size_t>(rig)],
             trials_ / kind_.rigs + (rig < trials_ % kind_.rigs ? 1 : 0));
  }
  const statistics::ClusteredProportion proportion = statistics::clustered_proportion(sums, confidence);
  return {proportion.value, proportion.korn_graubard, proportion.wilson};
}

MeasureStatistics MeasureAccumulator::statistics(const StatisticsOptions& options) const {
  MeasureStatistics result;
  result.n = result.moves = moments_.n;
  result.nonfinite = moments_.nonfinite;
  result.mean = moments_.mean;
  result.sd = moments_.sd();
  result.rms = moments_.rms();
  result.min = moments_.min;
  result.max = moments_.max;
  if (reports(*reported_, layout::Statistic::student_low))
    result.mean_bounds = statistics::student_t(moments_, options.confidence);
  if (layout::is_quality(*measure_)) {
    result.trials = std::accumulate(hits_.begin(), hits_.end(), std::int64_t{0});
    result.by_move = by_move_;
    if (reports(*reported_, layout::Statistic::rate)) result.rate = rate(options.confidence);
  }
  if (!in_clusters_) return result;

  const statistics::ClusteredSample sample = clusters_.sample();
  const statistics::Histogram<double>& values = sample.observed();
  const auto quantile = [&](layout::Statistic statistic, double probability) {
    return reports(*reported_, statistic)
               ? statistics::clustered_quantile(sample, probability, options.confidence)
               : MeasureStatistics::no_quantile;
  };
  result.n = values.size;
  result.moves = sample.size();
  for (const auto& [value, count] : values.counts) result.trials += value > 0.0 ? count : 0;
  if (measure_->of_trial == layout::OfTrial::sum) result.total = std::llround(statistics::total(values));
  result.mean = statistics::mean(values);
  result.sd = statistics::standard_deviation(values);
  result.min = statistics::smallest(values);
  result.max = statistics::largest(values);
  result.p05 = quantile(layout::Statistic::p05, 0.05);
  result.p25 = quantile(layout::Statistic::p25, 0.25);
  result.median = quantile(layout::Statistic::median, 0.5);
  result.p75 = quantile(layout::Statistic::p75, 0.75);
  result.p95 = quantile(layout::Statistic::p95, 0.95);
  if (options.bootstrap && trials_ > 0 && !kind_.open_loop &&
      reports(*reported_, layout::Statistic::bootstrap_low)) {
    const std::string name = fmt::format("bootstrap/{}.mean", measure_->field.column.name);
    const random::RandomStream stream{designs::random_key(options.bootstrap->seed, name),
                                      options.bootstrap->stream};
    result.mean_bounds = measure_->of_trial == layout::OfTrial::sum
                             ? statistics::clustered_count_bounds(totals_, stream, options.confidence)
                             : statistics::clustered_mean_bounds(totals_, stream, options.confidence);
  }
  return result;
}

}  // namespace zerocount::measures
