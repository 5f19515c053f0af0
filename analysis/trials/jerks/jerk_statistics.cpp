#include "analysis/trials/jerks/jerk_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/by_cluster.hpp"
#include "analysis/basis/statistics/clusters/trial_clusters.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/sums/histogram.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/sign.hpp"
#include "core/trial/divergence.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::jerks {
namespace {

[[noreturn]] void fail(const reading::AllTrialsFile& file, std::int64_t row, const std::string& what) {
  throw Failure(ExitCode::bad_data, fmt::format("{}: trial {}: {}", file.path().string(), row, what));
}

/// Whether parameters of the timing (sample rate, hold, arrival dwell) are drawn for each trial. If not, all
/// trials have the same timing.
bool have_own_timing(const study::Study& study) {
  return std::ranges::any_of(study.columns.inputs, [](const study::InputColumn& input) {
    return input.name == parameter::controller::sample_rate || input.name == parameter::command::hold ||
           input.name == parameter::verdict::dwell;
  });
}

/// Number of observed samples of a move, from its arrival to its end. A move that was stopped early had
/// diverged: it counts as a jerk that lasted to the end of the observation.
/// @param samples planned number of samples of the move
std::int64_t observed_end(const ObservedMove& observed, const trial::MoveOutcome& move,
                          std::int64_t samples) {
  if (!move.stopped || observed.jerks.empty()) return samples - move.arrival;
  return observed.jerks.back().onset + observed.jerks.back().length;
}

bool in_order(const ObservedMove& move) {
  std::int64_t at_risk = move.dwell;
  for (const SampledJerk& jerk : move.jerks) {
    if (jerk.onset < at_risk || jerk.length < 1 || jerk.onset + jerk.length > move.end) return false;
    at_risk = jerk.onset + jerk.length + 1;
  }
  return true;
}

ObservedMove observe(const trial::TrialParameters& parameters, std::size_t index,
                     const trial::MoveOutcome& move, std::span<const layout::JerkRecord> jerks) {
  const double rate = parameters.controller.sample_rate;
  ObservedMove observed;
  observed.arrived = move.arrived;
  observed.lost = move.outcome == trial::Outcome::nonfinite;
  observed.sample_time = 1.0 / rate;
  observed.dwell = trial::samples_in(parameters.verdict.dwell, rate);
  for (const layout::JerkRecord& jerk : jerks)
    observed.jerks.push_back({std::llround(jerk.onset * rate) - move.arrival,
                              std::llround(jerk.duration * rate), jerk.magnitude,
                              jerk.direction == numerics::sign_of(move.holding_torque)});
  observed.end = observed_end(observed, move, trial::samples_of_move(parameters, index));
  return observed;
}

constexpr double per_decade = 5.0;

double range_begin(std::int64_t j) {
  return std::pow(10.0, static_cast<double>(j) / per_decade);
}

/// Index of the first sample in range `j` of the time since arrival; the range begins at 10^(j/5) s.
std::int64_t first_sample(std::int64_t j, double sample_time) {
  constexpr double rounding = 1e-12;
  return static_cast<std::int64_t>(std::ceil(range_begin(j) / sample_time * (1.0 - rounding)));
}

constexpr std::size_t magnitude_classes = 3;  // one count, two, and more

/// Duration of this number of samples, s, rounded to 1 ps, so that equal numbers of samples give equal times.
double time_of(std::int64_t samples, const ObservedMove& move) {
  return std::round(static_cast<double>(samples) * move.sample_time * 1e12) / 1e12;
}

/// Numbers of samples between the onsets of successive jerks of a move.
std::vector<std::int64_t> intervals_of(const ObservedMove& move) {
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < move.jerks.size(); ++i)
    intervals.push_back(move.jerks[i].onset - move.jerks[i - 1].onset);
  return intervals;
}

/// Numbers of jerks of one cluster of dependent moves (a trial or a machine): all, those in the direction of
/// the holding torque, and those of one count.
struct JerkCounts {
  std::int64_t jerks{0}, agreeing{0}, of_one_count{0};
};

JerkIntervals interval_statistics(const statistics::ClusteredSample& sample, double confidence) {
  JerkIntervals intervals{sample.observed().size, statistics::mean(sample.observed())};
  std::ranges::transform(jerk_interval_probabilities, intervals.quantiles.begin(), [&](double probability) {
    return statistics::clustered_quantile(sample, probability, confidence);
  });
  return intervals;
}

/// Collects the moves of a design point, and computes the statistics of their jerks.
class JerkCollector {
 public:
  JerkCollector(double confidence, std::int64_t machines)
      : confidence_(confidence), rates_(machines > 0), trend_(confidence), intervals_(machines) {}

  void add(const ObservedMove& move) {
    if (move.cluster != cluster_) close_cluster();
    cluster_ = move.cluster;
    ++found_.moves;
    if (!move.arrived) return;
    ++found_.arrived;
    if (move.lost) {
      ++found_.lost;
      return;
    }
    rates_.add(move);
    const std::vector<std::int64_t> intervals = intervals_of(move);
    trend_.add(intervals);
    for (const std::int64_t interval : intervals) intervals_of_cluster_.push_back(time_of(interval, move));
    for (const SampledJerk& jerk : move.jerks) add_jerk(move, jerk);
  }

  JerkStatistics statistics() {
    close_cluster();
    JerkStatistics result = found_;
    result.confidence = confidence_;
    result.rates = rates_.rates(confidence_);
    result.slowing = trend_.summary();
    result.agreement = proportion(&JerkCounts::agreeing);
    result.intervals = interval_statistics(intervals_.sample(), confidence_);
    JerkMagnitudes& magnitudes = result.magnitudes;
    magnitudes.one_count = proportion(&JerkCounts::of_one_count);
    magnitudes.counts.assign(magnitude_counts_.begin(), magnitude_counts_.end());
    magnitudes.mean = statistics::mean(magnitudes_);
    magnitudes.max = magnitudes_.size > 0 ? magnitudes_.counts.rbegin()->first : 0;
    magnitudes.median_duration = statistics::quantile(durations_, 0.5, confidence_).value;
    magnitudes.longest_duration = statistics::largest(durations_);
    return result;
  }

 private:
  statistics::ClusteredProportion proportion(std::int64_t JerkCounts::*hits) const {
    statistics::ClusterSums sums;
    for (const JerkCounts& cluster : counts_.sums()) sums.add(cluster.*hits, cluster.jerks);
    return statistics::clustered_proportion(sums, confidence_);
  }

  void close_cluster() {
    intervals_.add_trial(cluster_, intervals_of_cluster_, std::ssize(intervals_of_cluster_));
    intervals_of_cluster_.clear();
  }

  void add_jerk(const ObservedMove& move, const SampledJerk& jerk) {
    ++found_.jerks;
    found_.with_jerks += move.trial != last_with_jerks_;
    last_with_jerks_ = move.trial;
    JerkCounts& counts = counts_.sum_of(move.cluster);
    ++counts.jerks;
    counts.agreeing += jerk.agrees;
    counts.of_one_count += jerk.magnitude == 1;
    magnitudes_.add(jerk.magnitude);
    durations_.add(time_of(jerk.length, move));
    const auto last = static_cast<std::int64_t>(magnitude_classes);
    ++magnitude_counts_[static_cast<std::size_t>(std::clamp<std::int64_t>(jerk.magnitude, 1, last) - 1)];
  }

  double confidence_;
  JerkStatistics found_;
  JerkRates rates_;
  TrendSum trend_;
  statistics::ByCluster<JerkCounts> counts_;
  statistics::TrialClusters intervals_;
  std::vector<double> intervals_of_cluster_;
  std::int64_t cluster_{0};
  statistics::Histogram<double> durations_;
  statistics::Histogram<std::int64_t> magnitudes_;
  std::array<std::int64_t, magnitude_classes> magnitude_counts_{};
  std::int64_t last_with_jerks_{-1};
};

void require_jerks(const reading::AllTrialsFile& file, const study::Study& study) {
  if (study.open_loop) {
    throw Failure(ExitCode::bad_data, fmt::format("{}: an open-loop study has no targets, and so no jerks",
                                                  file.path().string()));
  }
}

}  // namespace

void for_each_run_at_risk(const ObservedMove& move,
                          const std::function<void(std::int64_t, std::int64_t)>& take) {
  std::int64_t first = move.dwell;
  for (const SampledJerk& jerk : move.jerks) {
    take(first, jerk.onset + 1);
    first = jerk.onset + jerk.length + 1;
  }
  if (first < move.end) take(first, move.end);
}

void for_each_move(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                   const std::function<void(const ObservedMove&)>& take) {
  const std::int64_t moves = file.moves();
  const std::int64_t trials = file.header().trials;
  const std::int64_t begin = point * trials;
  const std::int64_t end = begin + trials;
  const bool own_timing = have_own_timing(study);
  trial::TrialParameters parameters = study::study_trial(study, point, 0).parameters;
  for (std::int64_t first = begin; first < end; first += layout::chunk_rows(moves)) {
    const layout::RowRange block{first, std::min(layout::chunk_rows(moves), end - first)};
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes(block);
    const std::vector<layout::JerkRecord> jerks = file.jerks(block);
    std::size_t next = 0;
    for (std::int64_t i = 0; i < block.count * moves; ++i) {
      const std::int64_t row = block.first + i / moves;
      const trial::MoveOutcome& move = outcomes[static_cast<std::size_t>(i)];
      const std::size_t start = next;
      while (next < jerks.size() && jerks[next].trial == row && jerks[next].move == i % moves) ++next;
      const std::span<const layout::JerkRecord> own = std::span(jerks).subspan(start, next - start);
      if (std::ssize(own) != move.jerk_count) {
        fail(file, row,
             fmt::format("{} jerks recorded of a move that counted {}", own.size(), move.jerk_count));
      }
      if (own_timing && i % moves == 0) parameters = study::study_trial(study, point, row - begin).parameters;
      ObservedMove observed = observe(parameters, static_cast<std::size_t>(i % moves), move, own);
      observed.trial = row;
      observed.cluster =
          study.machines > 0 ? study::group_of(study, study::Grouping::machine, row - begin) : row;
      if (observed.arrived && !observed.lost && !in_order(observed)) {
        fail(file, row, "jerks that are not in order, or outside the time of their move");
      }
      take(observed);
    }
    if (next != jerks.size()) fail(file, jerks[next].trial, "jerks beyond those that its moves counted");
  }
}

std::int64_t JerkRates::range_of(std::int64_t sample, double sample_time) {
  if (sample_time != sample_time_) {
    sample_time_ = sample_time;
    first_range_ = static_cast<std::int64_t>(std::floor(per_decade * std::log10(sample_time)));
    while (1 < first_sample(first_range_, sample_time)) --first_range_;
    while (1 >= first_sample(first_range_ + 1, sample_time)) ++first_range_;
    ends_.clear();
  }
  while (ends_.empty() || sample >= ends_.back())
    ends_.push_back(first_sample(first_range_ + std::ssize(ends_) + 1, sample_time));
  return first_range_ + (std::ranges::upper_bound(ends_, sample) - ends_.begin());
}

void JerkRates::Range::close_clusters() {
  for (const auto& [number, cluster] : open) {
    clusters += cluster.exposure > 0.0;
    jerks_squared += cluster.jerks * cluster.jerks;
    jerks_by_exposure += cluster.jerks * cluster.exposure;
    exposure_squared += cluster.exposure * cluster.exposure;
  }
  open.clear();
}

JerkRates::Range& JerkRates::range_at(std::int64_t j, const ObservedMove& move) {
  Range& range = ranges_[j];
  if (!clusters_return_ && !range.open.contains(move.cluster)) range.close_clusters();
  range.moves += range.move != moves_;
  range.move = moves_;
  return range;
}

void JerkRates::add_exposure(const ObservedMove& move, std::int64_t first, std::int64_t end) {
  if (first >= end) return;
  range_of(end - 1, move.sample_time);  // so that ends_ has all ranges
  for (std::int64_t j = range_of(first, move.sample_time); first < end; ++j) {
    const std::int64_t next = std::min(end, ends_[static_cast<std::size_t>(j - first_range_)]);
    const double exposure = static_cast<double>(next - first) * move.sample_time;
    Range& range = range_at(j, move);
    range.exposure += exposure;
    range.open[move.cluster].exposure += exposure;
    first = next;
  }
}

void JerkRates::add(const ObservedMove& move) {
  ++moves_;
  earliest_ = std::min(earliest_, static_cast<double>(move.dwell) * move.sample_time);
  latest_ = std::max(latest_, static_cast<double>(move.end) * move.sample_time);
  for_each_run_at_risk(move, [&](std::int64_t first, std::int64_t end) { add_exposure(move, first, end); });
  for (const SampledJerk& jerk : move.jerks) {
    Range& range = range_at(range_of(jerk.onset, move.sample_time), move);
    ++range.jerks;
    range.open[move.cluster].jerks += 1.0;
  }
}

std::vector<JerkRate> JerkRates::rates(double confidence) const {
  statistics::require_confidence(confidence);
  std::vector<JerkRate> rates;
  for (const auto& [j, counted] : ranges_) {
    Range range = counted;
    range.close_clusters();
    const auto jerks = static_cast<double>(range.jerks);
    const auto clusters = static_cast<double>(range.clusters);
    JerkRate rate{.from = std::max(range_begin(j), earliest_), .to = std::min(range_begin(j + 1), latest_)};
    rate.moves = range.moves;
    rate.exposure = range.exposure;
    rate.jerks = range.jerks;
    rate.rate = jerks / range.exposure;
    if (range.jerks > 0 && range.clusters > 1) {
      const double squares = range.jerks_squared - 2.0 * rate.rate * range.jerks_by_exposure +
                             rate.rate * rate.rate * range.exposure_squared;
      rate.dispersion = clusters / (clusters - 1.0) * std::max(0.0, squares) / jerks;
    }
    const auto scaled_bounds = [&](double divisor) {
      const statistics::ConfidenceInterval mean = statistics::poisson_bounds(jerks / divisor, confidence);
      const double exposure = range.exposure / divisor;
      return statistics::ConfidenceInterval{mean.low / exposure, mean.high / exposure};
    };
    rate.poisson = scaled_bounds(1.0);
    rate.bounds = scaled_bounds(std::max(1.0, rate.dispersion));
    rates.push_back(rate);
  }
  return rates;
}

JerkStatistics jerk_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                               std::int64_t point, double confidence) {
  require_jerks(file, study);
  statistics::require_confidence(confidence);
  JerkCollector collector(confidence, study.machines);
  for_each_move(file, study, point, [&](const ObservedMove& move) { collector.add(move); });
  JerkStatistics result = collector.statistics();
  result.trials = file.header().trials;
  return result;
}

}  // namespace zerocount::jerks
