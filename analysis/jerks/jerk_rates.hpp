#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "analysis/jerks/jerk_statistics.hpp"
#include "analysis/jerks/observed_move.hpp"

namespace zerocount {

/// Counts jerks and the time in which they could begin, over ranges of the time since arrival that meet at
/// 10^(j/5) s, j whole: five to a decade.
class JerkRates {
 public:
  /// @param clusters_return whether moves of one cluster come between those of others: trials do not, rigs do
  explicit JerkRates(bool clusters_return = false) : clusters_return_(clusters_return) {}
  /// @param move one that arrived and was not lost; moves in order of their trials.
  void add(const ObservedMove& move);
  /// In order of time; the first begins with the first instant at which any move could jerk, the last ends
  /// with the longest observation.
  std::vector<JerkRate> rates(double confidence) const;

 private:
  struct Cluster {
    double jerks{0.0}, exposure{0.0};  ///< exposure in s
  };
  /// One range: the clusters that may have more moves, and sums over those that have not.
  struct Range {
    std::map<std::int64_t, Cluster> open;
    std::int64_t move{-1};  ///< number of the last move that was seen here
    std::int64_t moves{0}, clusters{0}, jerks{0};
    double exposure{0.0}, jerks_squared{0.0}, jerks_by_exposure{0.0}, exposure_squared{0.0};

    void close_clusters();
  };
  Range& range_at(std::int64_t j, const ObservedMove& move);
  void add_exposure(const ObservedMove& move, std::int64_t first, std::int64_t end);

  bool clusters_return_;
  std::map<std::int64_t, Range> ranges_;
  std::int64_t moves_{0};
  double earliest_{std::numeric_limits<double>::infinity()};  ///< s
  double latest_{0.0};                                        ///< s
};

}  // namespace zerocount
