#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "analysis/jerks/jerk_statistics.hpp"
#include "analysis/jerks/observed_move.hpp"

namespace zerocount::jerks {

/// Counts jerks and exposure (the time in which jerks could begin) in ranges of the time since arrival. The
/// ranges are bounded by 10^(j/5) s for integers j: five per decade.
class JerkRates {
 public:
  /// @param clusters_return whether the moves of one cluster may be interleaved with those of others: true
  /// for rigs, false for trials
  explicit JerkRates(bool clusters_return = false) : clusters_return_(clusters_return) {}
  /// @param move a move that arrived and was not lost. Moves must be added in order of their trials.
  void add(const ObservedMove& move);
  /// In order of time. The first range begins with the earliest possible jerk of any move; the last range
  /// ends with the longest observation.
  std::vector<JerkRate> rates(double confidence) const;

 private:
  struct Cluster {
    double jerks{0.0}, exposure{0.0};  ///< exposure in s
  };
  /// One range: the clusters that may still receive moves, and sums over the completed clusters.
  struct Range {
    std::map<std::int64_t, Cluster> open;
    std::int64_t move{-1};  ///< number of the last move added to this range
    std::int64_t moves{0}, clusters{0}, jerks{0};
    double exposure{0.0}, jerks_squared{0.0}, jerks_by_exposure{0.0}, exposure_squared{0.0};

    void close_clusters();
  };
  /// The range that contains a sample.
  std::int64_t range_of(std::int64_t sample, double sample_time);
  Range& range_at(std::int64_t j, const ObservedMove& move);
  void add_exposure(const ObservedMove& move, std::int64_t first, std::int64_t end);

  bool clusters_return_;
  std::map<std::int64_t, Range> ranges_;
  double sample_time_{0.0};         ///< s, of the last move
  std::int64_t first_range_{0};     ///< with this sample time, that of sample 1
  std::vector<std::int64_t> ends_;  ///< of the ranges from that one on, in samples
  std::int64_t moves_{0};
  double earliest_{std::numeric_limits<double>::infinity()};  ///< s
  double latest_{0.0};                                        ///< s
};

}  // namespace zerocount::jerks
