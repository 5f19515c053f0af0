#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/measures/measure_statistics.hpp"
#include "analysis/measures/statistics_options.hpp"
#include "analysis/statistics/clustered_mean.hpp"
#include "analysis/statistics/trial_clusters.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// What is known of the moves before they are looked at.
struct MoveKind {
  bool open_loop{false};                         ///< they have torque levels, and no target
  std::int64_t version{layout::format_version};  ///< of the layout of the results they are from
  std::int64_t rigs{0};  ///< that the trials run on, trial i on rig i mod rigs; 0: no trials share one
};

/// Takes one measure of the trials of a design point, one after the other, and gives its statistics. The
/// trials of one rig and the moves of one trial are clusters: bounds allow for what they have in common.
///
/// Sums, and values of which there are quantiles, are kept as how often each occurred: the memory grows with
/// their distinct values, not with the number of trials.
class MeasureAccumulator {
 public:
  /// @param measure stays as long as this. @param reported of the measure: its statistics at a point, or at
  /// a level.
  MeasureAccumulator(const layout::Measure& measure, const layout::ReportedStatistics& reported,
                     const MoveKind& kind);

  void add(std::span<const trial::MoveOutcome> moves);
  MeasureStatistics statistics(const StatisticsOptions& options) const;

 private:
  void add_quality(std::span<const trial::MoveOutcome> moves);
  void add_clusters(std::int64_t size);
  RateWithBounds rate(double confidence) const;

  const layout::Measure* measure_;
  const layout::ReportedStatistics* reported_;
  MoveKind kind_;
  bool in_clusters_;  ///< kept by their values; otherwise by their moments
  std::int64_t trials_{0};
  statistics::Moments moments_;
  statistics::TrialClusters clusters_;
  statistics::ClusterTotals totals_;
  std::vector<std::int64_t> by_move_;  ///< [move] trials whose move has the quality
  std::vector<std::int64_t> hits_;     ///< [rig], or one for all: trials that have the quality
  std::vector<double> values_;         ///< of the trial at hand; kept for its memory
};

}  // namespace zerocount::measures
