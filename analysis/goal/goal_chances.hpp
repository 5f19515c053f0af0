#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "analysis/measures/move_counts.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::goal {

/// Size of one world of a planned study, or of a study without worlds.
struct PlannedSize {
  std::int64_t units{0};             ///< rigs, or trials without rigs
  std::int64_t more_on_each_rig{1};  ///< trials of a rig, as a multiple of those observed
};

/// Probabilities of the verdicts that a planned study will have.
struct Chances {
  double met{0.0};
  double missed{0.0};
};

/// The chances of a planned study of one world, after what was observed in it. The proportion π that the
/// verdict is about is not known: it has the distribution that the observation leaves likely, Beta(k + ½,
/// n − k + ½) for k of n independent events (the posterior of Jeffreys' prior; assurance after O'Hagan,
/// Stevens and Campbell, Pharmaceutical Statistics 4 (2005) 187).
///
/// Events are moves, as many as the clusters observed are worth. Without a miss, or without a hit, nothing
/// tells how clusters differ, and each move is one; the bounds of the planned study count its clusters: with
/// e1 of a rig of m moves, a rig of c·m moves is worth 1/(1/e1 − 1/m + 1/(c·m)). For a goal on machines the
/// planned rigs are like those observed, each of which meets the goal in its moves as often as observed: the
/// bounds of rig_proportion.hpp leave a range of proportions open that no study decides, so that what is
/// likely cannot be decided with any probability.
class ObservedWorld {
 public:
  /// @param counts of one world, with moves @param points, parts as of judge_goal()
  ObservedWorld(const study::Goal& goal, measures::MoveCounts counts, std::size_t points, std::size_t parts);

  Chances chances_of(const PlannedSize& planned);

 private:
  /// Equally probable values of a proportion that is not known.
  using Proportions = std::array<double, 100>;

  static Proportions likely_proportions(double hits, double events);
  static double chance_of_at_least(const Proportions& proportions, std::int64_t events, std::int64_t hits);
  double planned_events(const PlannedSize& planned) const;
  double rigs_passing(std::int64_t met, std::int64_t more);
  Chances of_moves(const PlannedSize& planned) const;
  Chances of_machines(const PlannedSize& planned);

  study::Goal goal_;
  measures::MoveCounts counts_;
  std::size_t points_;
  std::size_t parts_;
  double confidence_low_, confidence_high_;  ///< of the bounds
  statistics::ClusterSums sums_;
  double worth_{0.0};  ///< events that the clusters are worth
  Proportions of_all_moves_{};
  std::map<std::int64_t, std::int64_t>
      machines_{};  ///< number of those with so many moves that meet the goal
  std::map<std::pair<std::int64_t, std::int64_t>, double> passing_{};  ///< rigs_passing()
};

}  // namespace zerocount::goal
