#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/measures/point_accumulator.hpp"
#include "analysis/trials/measures/stream_name.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/trial/divergence.hpp"
#include "experiments/designs/designs.hpp"

namespace zerocount::measures {
namespace {

/// Zero that is added to values before they are counted, so that −0 becomes 0. The two are equal, so which of
/// them represents both in a histogram must not depend on their order.
constexpr double positive_zero = 0.0;

bool needs_every_value(const layout::Measure& measure, const layout::ReportedStatistics& reported) {
  return measure.reduction == layout::MoveReduction::sum || reports(reported, layout::Statistic::median) ||
         reports(reported, layout::Statistic::p95);
}

/// Adds the elements of `added` to those of `counts`, and makes `counts` longer if necessary.
void add_counts(std::vector<std::int64_t>& counts, const std::vector<std::int64_t>& added) {
  if (counts.size() < added.size()) counts.resize(added.size());
  std::transform(added.begin(), added.end(), counts.begin(), counts.begin(), std::plus{});
}

/// Whether no count is negative and all add up to `total`.
bool is_sum_of(const std::vector<std::int64_t>& counts, std::int64_t total) {
  for (const std::int64_t count : counts) {
    if (count < 0 || count > total) return false;
    total -= count;
  }
  return total == 0;
}

}  // namespace

MeasureAccumulator::MeasureAccumulator(const layout::Measure& measure,
                                       const layout::ReportedStatistics& reported, const MoveKind& kind)
    : measure_(&measure),
      reported_(&reported),
      kind_(kind),
      in_clusters_(needs_every_value(measure, reported)),
      has_mean_bounds_(reports(reported, layout::Statistic::bootstrap_low)),
      counts_moves_(reports(reported, layout::Statistic::moves_rate)),
      clusters_(kind.shape.machines),
      of_moves_({kind.shape.machines, 0, 0}) {}

void MeasureAccumulator::add(const MovesOfTrials& some) {
  if (reported_->texts.empty()) return;
  if (layout::is_quality(*measure_)) {
    add_qualities(some);
  } else if (measure_->reduction == layout::MoveReduction::sum) {
    add_sums(some);
  } else if (!(measure_->values.needs_target && kind_.open_loop)) {
    add_values(some);
  }
  trials_ += some.trials();
}

void MeasureAccumulator::add_qualities(const MovesOfTrials& some) {
  by_move_.resize(some.of_trial);
  const auto of_trial = static_cast<std::int64_t>(some.of_trial);
  const std::int64_t wanted = wanted_moves(*measure_, of_trial);
  values_.resize(some.moves.size());
  layout::qualities_of(*measure_, some.moves, values_);
  std::int64_t having = 0;  // without machines
  auto quality = values_.cbegin();
  for (std::int64_t trial = some.first_trial; quality != values_.cend(); ++trial) {
    std::int64_t moves = 0;
    for (std::int64_t& of_move : by_move_) {
      const bool has = *quality++ != 0.0;
      of_move += has;
      moves += has;
    }
    if (kind_.shape.machines > 0) {
      judged_.add(trial % kind_.shape.machines, 1);
      hits_.add(trial % kind_.shape.machines, moves >= wanted);
    }
    having += moves >= wanted;
    if (counts_moves_) of_moves_.add(trial, of_trial, moves);
  }
  if (kind_.shape.machines > 0) return;
  judged_.add(0, some.trials());
  hits_.add(0, having);
}

void MeasureAccumulator::add_sums(const MovesOfTrials& some) {
  std::vector<double> of_moves(some.moves.size());
  layout::values_of(measure_->field, some.moves, of_moves);
  values_.clear();
  for (std::span<const double> rest(of_moves); !rest.empty(); rest = rest.subspan(some.of_trial))
    values_.push_back(sum_of_moves(rest.first(some.of_trial)));
  add_totals(some.first_trial, 1);
  clusters_.add_trials(some.first_trial, values_, 1, false);
}

void MeasureAccumulator::add_values(const MovesOfTrials& some) {
  values_.resize(some.moves.size());
  layout::values_of(measure_->field, some.moves, values_);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const trial::MoveOutcome& move = *some.moves[i];
    values_[i] = counted_value(*measure_, move, values_[i]) + positive_zero;
    if (!in_clusters_ && trial::was_run(move)) moments_.add(values_[i]);
  }
  add_totals(some.first_trial, some.of_trial);
  if (in_clusters_)
    clusters_.add_trials(some.first_trial, values_, some.of_trial,
                         measure_->values.missing == layout::Missing::late);
}

/// Adds the values of several trials, values_ as [trial][value], to the totals of their clusters (machines).
/// @param trial index of the first trial
/// @param of_trial number of values of a trial
void MeasureAccumulator::add_totals(std::int64_t trial, std::size_t of_trial) {
  if (!has_mean_bounds_) return;
  std::vector<double> known;
  for (std::span<const double> values(values_); !values.empty(); values = values.subspan(of_trial)) {
    statistics::find_known(values.first(of_trial), known);
    totals_.add(kind_.shape.machines > 0 ? trial % kind_.shape.machines : trial, known);
    ++trial;
  }
}

MeasureAccumulator& MeasureAccumulator::operator+=(const MeasureAccumulator& next) {
  trials_ += next.trials_;
  moments_ += next.moments_;
  clusters_ += next.clusters_;
  totals_ += next.totals_;
  add_counts(by_move_, next.by_move_);
  judged_ += next.judged_;
  hits_ += next.hits_;
  of_moves_ += next.of_moves_;
  return *this;
}

bool MeasureAccumulator::is_valid(std::int64_t trials, std::int64_t moves) const {
  const bool is_reported = !reported_->texts.empty();
  if (trials_ != (is_reported ? trials : 0)) return false;
  const std::int64_t all_moves = trials * moves;
  return has_valid_qualities(moves) && has_valid_totals() && moments_.n >= 0 && moments_.nonfinite >= 0 &&
         moments_.n <= all_moves - moments_.nonfinite && clusters_.size() <= all_moves;
}

bool MeasureAccumulator::has_valid_qualities(std::int64_t moves) const {
  if (!layout::is_quality(*measure_) || trials_ == 0)
    return by_move_.empty() && judged_.sums().empty() && hits_.sums().empty();
  const std::int64_t machines = std::max<std::int64_t>(kind_.shape.machines, 1);
  if (std::ssize(by_move_) != moves || judged_.end() > machines || hits_.end() > machines) return false;
  for (std::int64_t machine = 0; machine < machines; ++machine)
    if (hits_[machine] < 0 || hits_[machine] > judged_[machine]) return false;
  return is_sum_of(judged_.sums(), trials_) && statistics::are_counts(by_move_, trials_) &&
         (!counts_moves_ || of_moves_.is_valid(trials_, moves));
}

bool MeasureAccumulator::has_valid_totals() const {
  const std::vector<std::int64_t>& numbers = totals_.numbers.sums();
  if (totals_.sums.sums().empty()) return numbers.empty() && totals_.added.sums().empty();
  return totals_.sums.end() <= statistics::max_clusters && totals_.sums.end() == totals_.numbers.end() &&
         totals_.sums.end() == totals_.added.end() && is_sum_of(totals_.added.sums(), trials_) &&
         std::all_of(numbers.begin(), numbers.end(), [](std::int64_t n) { return n >= 0; });
}

RateWithBounds MeasureAccumulator::rate_of_moves(double confidence) const {
  const statistics::ClusteredProportion proportion =
      statistics::clustered_proportion(clusters_of(of_moves_.sum()), confidence);
  return {proportion.value, proportion.korn_graubard, proportion.wilson};
}

statistics::ConfidenceInterval MeasureAccumulator::bootstrap_bounds(const StatisticsOptions& options) const {
  const std::string name = fmt::format("bootstrap/{}.mean", stream_name(measure_->field.column.name));
  const random::RandomStream stream{designs::random_key(options.bootstrap->seed, name),
                                    options.bootstrap->stream};
  return measure_->reduction == layout::MoveReduction::sum
             ? statistics::clustered_count_bounds(totals_, stream, options.confidence)
             : statistics::clustered_mean_bounds(totals_, stream, options.confidence);
}

RateWithBounds MeasureAccumulator::rate(double confidence) const {
  if (trials_ == 0 || kind_.open_loop) return {};
  if (kind_.shape.machines == 0) {
    return {zerocount::statistics::rate(hits_[0], trials_),
            statistics::clopper_pearson(hits_[0], trials_, confidence),
            statistics::wilson(hits_[0], trials_, confidence)};
  }
  statistics::ClusterSums sums;
  for (std::int64_t machine = 0; machine < judged_.end(); ++machine)
    sums.add(hits_[machine], judged_[machine]);
  const statistics::ClusteredProportion proportion = statistics::clustered_proportion(sums, confidence);
  return {proportion.value, proportion.korn_graubard, proportion.wilson};
}

MeasureStatistics MeasureAccumulator::statistics(const StatisticsOptions& options) const {
  MeasureStatistics result;
  const statistics::Moments moments = moments_.moments();
  result.n = result.moves = moments.n;
  result.nonfinite = moments.nonfinite;
  result.mean = moments.mean;
  result.sd = moments.sd();
  result.rms = moments.rms();
  result.min = moments.min;
  result.max = moments.max;
  if (reports(*reported_, layout::Statistic::student_low))
    result.mean_bounds = statistics::student_t(moments, options.confidence);
  if (layout::is_quality(*measure_)) {
    result.trials = std::accumulate(hits_.sums().begin(), hits_.sums().end(), std::int64_t{0});
    result.by_move = by_move_;
    if (reports(*reported_, layout::Statistic::rate)) result.rate = rate(options.confidence);
    if (counts_moves_ && trials_ > 0 && !kind_.open_loop)
      result.moves_rate = rate_of_moves(options.confidence);
  }
  if (has_mean_bounds_ && options.bootstrap && trials_ > 0 && !kind_.open_loop)
    result.mean_bounds = bootstrap_bounds(options);
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
  if (measure_->reduction == layout::MoveReduction::sum)
    result.total = std::llround(statistics::total(values));
  result.mean = statistics::mean(values);
  result.sd = statistics::standard_deviation(values);
  result.min = statistics::smallest(values);
  result.max = statistics::largest(values);
  result.p05 = quantile(layout::Statistic::p05, 0.05);
  result.p25 = quantile(layout::Statistic::p25, 0.25);
  result.median = quantile(layout::Statistic::median, 0.5);
  result.p75 = quantile(layout::Statistic::p75, 0.75);
  result.p95 = quantile(layout::Statistic::p95, 0.95);
  return result;
}

}  // namespace zerocount::measures
