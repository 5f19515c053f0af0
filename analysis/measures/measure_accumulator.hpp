#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/measure_statistics.hpp"
#include "analysis/statistics/clustered_mean.hpp"
#include "analysis/statistics/trial_clusters.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// Properties that all moves of a study share.
struct MoveKind {
  bool open_loop{false};                         ///< torque levels in place of targets
  std::int64_t version{layout::format_version};  ///< of the layout of the results file
  std::int64_t rigs{0};  ///< number of rigs, trial i on rig i mod rigs; 0: no trials share a rig
};

/// Where the resampling of a design point draws its random numbers.
struct BootstrapDraws {
  std::uint64_t seed{0};    ///< of the study
  std::uint32_t stream{0};  ///< the design point
};

/// How the statistics of a design point are made.
struct StatisticsOptions {
  double confidence{statistics::summary_confidence};
  std::optional<BootstrapDraws> bootstrap{};  ///< none: the bounds of means are left open
  /// Whether the trials went on until their outcomes were known well enough: claims about all axes need
  /// bounds that allow for it then.
  bool stopped_by_outcomes{false};
};

/// Collects one measure of the trials of a design point and computes its statistics. The trials of one rig
/// and the moves of one trial are clusters: the bounds account for their correlation.
///
/// Sums, and values with quantiles, are kept as histograms: the memory grows with the number of distinct
/// values, not with the number of trials.
class MeasureAccumulator {
 public:
  /// @param measure must outlive this object. @param reported the measure's statistics at a point, or at a
  /// level.
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
  bool in_clusters_;  ///< whether values are kept in clusters; otherwise only their moments
  std::int64_t trials_{0};
  statistics::Moments moments_;
  statistics::TrialClusters clusters_;
  statistics::ClusterTotals totals_;
  std::vector<std::int64_t> by_move_;  ///< [move] trials whose move has the quality
  std::vector<std::int64_t> hits_;     ///< [rig], or one for all: trials with the quality
  std::vector<double> values_;         ///< of the current trial
};

}  // namespace zerocount::measures
