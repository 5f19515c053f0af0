#include "analysis/jerks/jerk_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "analysis/jerks/jerk_rates.hpp"
#include "analysis/jerks/observed_move.hpp"
#include "analysis/statistics/clusters/trial_clusters.hpp"
#include "analysis/statistics/sums/histogram.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::jerks {
namespace {

constexpr std::size_t magnitude_classes = 3;  // one count, two, and more

/// Time between onsets, s, rounded to 1 ps, so that equal numbers of samples give equal times.
double interval_before(const ObservedMove& move, std::size_t jerk) {
  const auto samples = static_cast<double>(move.jerks[jerk].onset - move.jerks[jerk - 1].onset);
  return std::round(samples * move.sample_time * 1e12) / 1e12;
}

/// Samples between the onsets of successive jerks.
std::vector<std::int64_t> intervals_of(const ObservedMove& move) {
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < move.jerks.size(); ++i)
    intervals.push_back(move.jerks[i].onset - move.jerks[i - 1].onset);
  return intervals;
}

/// Hits and events of the clusters that may still receive events, and sums over the completed clusters.
class EventSums {
 public:
  /// @param clusters_return whether the events of one cluster may be interleaved with those of others: true
  /// for rigs, false for trials
  explicit EventSums(bool clusters_return = false) : clusters_return_(clusters_return) {}

  void add(std::int64_t cluster, bool hit) {
    if (!clusters_return_ && !open_.contains(cluster)) close();
    Counts& counts = open_[cluster];
    counts.hits += hit;
    ++counts.events;
  }
  const statistics::ClusterSums& sums() {
    close();
    return sums_;
  }

 private:
  struct Counts {
    std::int64_t hits{0}, events{0};
  };
  void close() {
    for (const auto& [number, counts] : open_) sums_.add(counts.hits, counts.events);
    open_.clear();
  }
  bool clusters_return_;
  std::map<std::int64_t, Counts> open_;
  statistics::ClusterSums sums_;
};

JerkIntervals interval_statistics(const statistics::ClusteredSample& sample, double confidence) {
  JerkIntervals intervals{sample.observed().size, statistics::mean(sample.observed()), {}, {}};
  for (const double probability : jerk_interval_probabilities) {
    intervals.quantiles.push_back(statistics::clustered_quantile(sample, probability, confidence));
    intervals.independent.push_back(
        statistics::effective_events(sample.at_most(intervals.quantiles.back().value)));
  }
  return intervals;
}

/// Collects the moves of a point.
class JerkCollector {
 public:
  JerkCollector(double confidence, std::int64_t rigs)
      : confidence_(confidence),
        rates_(rigs > 0),
        trend_(confidence),
        agreeing_(rigs > 0),
        one_count_(rigs > 0),
        intervals_(rigs) {}

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
    trend_.add(intervals_of(move));
    for (std::size_t i = 0; i < move.jerks.size(); ++i) {
      if (i > 0) intervals_of_cluster_.push_back(interval_before(move, i));
      add_jerk(move, move.jerks[i]);
    }
  }

  JerkStatistics statistics() {
    close_cluster();
    JerkStatistics result = found_;
    result.confidence = confidence_;
    result.rates = rates_.rates(confidence_);
    result.slowing = trend_.summary();
    result.agreement = statistics::clustered_proportion(agreeing_.sums(), confidence_);
    result.intervals = interval_statistics(intervals_.sample(), confidence_);
    JerkMagnitudes& magnitudes = result.magnitudes;
    magnitudes.one_count = statistics::clustered_proportion(one_count_.sums(), confidence_);
    magnitudes.counts.assign(magnitude_counts_.begin(), magnitude_counts_.end());
    magnitudes.mean = statistics::mean(magnitudes_);
    magnitudes.max = magnitudes_.size > 0 ? magnitudes_.counts.rbegin()->first : 0;
    magnitudes.median_duration = statistics::quantile(durations_, 0.5, confidence_).value;
    magnitudes.longest_duration = statistics::largest(durations_);
    return result;
  }

 private:
  void close_cluster() {
    intervals_.add_trial(cluster_, intervals_of_cluster_, std::ssize(intervals_of_cluster_));
    intervals_of_cluster_.clear();
  }

  void add_jerk(const ObservedMove& move, const SampledJerk& jerk) {
    ++found_.jerks;
    found_.with_jerks += move.trial != last_with_jerks_;
    last_with_jerks_ = move.trial;
    agreeing_.add(move.cluster, jerk.agrees);
    one_count_.add(move.cluster, jerk.magnitude == 1);
    magnitudes_.add(jerk.magnitude);
    durations_.add(std::round(static_cast<double>(jerk.length) * move.sample_time * 1e12) / 1e12);
    const auto last = static_cast<std::int64_t>(magnitude_classes);
    ++magnitude_counts_[static_cast<std::size_t>(std::clamp<std::int64_t>(jerk.magnitude, 1, last) - 1)];
  }

  double confidence_;
  JerkStatistics found_;
  JerkRates rates_;
  TrendSum trend_;
  EventSums agreeing_, one_count_;
  statistics::TrialClusters intervals_;
  std::vector<double> intervals_of_cluster_;
  std::int64_t cluster_{0};
  statistics::Histogram<double> durations_;
  statistics::Histogram<std::int64_t> magnitudes_;
  std::array<std::int64_t, magnitude_classes> magnitude_counts_{};
  std::int64_t last_with_jerks_{-1};
};

void require_jerks(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point) {
  if (study.open_loop) {
    throw Failure(ExitCode::bad_data, fmt::format("{}: an open-loop study has no targets, and so no jerks",
                                                  file.path().string()));
  }
  if (point < 0 || point >= study::point_count(study)) {
    throw Failure(ExitCode::bad_input, fmt::format("point {}; the study has points 0 to {}", point,
                                                   study::point_count(study) - 1));
  }
}

}  // namespace

JerkStatistics jerk_statistics(const reading::AllTrialsFile& file, const study::Study& study,
                               std::int64_t point, double confidence) {
  require_jerks(file, study, point);
  statistics::require_confidence(confidence);
  JerkCollector collector(confidence, study.rigs);
  for_each_move(file, study, point, [&](const ObservedMove& move) { collector.add(move); });
  JerkStatistics result = collector.statistics();
  result.trials = file.header().trials;
  return result;
}

}  // namespace zerocount::jerks
