#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/measures/move_event.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "runners/tuning/race/candidate.hpp"

namespace zerocount::tuning {

/// The largest of the criterion's values; 0 without values.
double latest(const ClaimResult& result);

/// The claim that the unit meets in the fewest moves, the latest of equal ones.
std::size_t worst_claim(const UnitResult& unit);

/// How a machine fails: the moves that miss a goal which asks them, and the score of each move
/// (measures::MoveScore::event).
class MachineFailures {
 public:
  MachineFailures(const study::Study& study, std::int64_t point);

  /// Adds the moves that the goals ask, those that meet them, and the score of each; the largest double where
  /// it was never reached.
  void add_to(ClaimResult& result, std::span<const trial::TrialOutcome> outcomes) const;

  /// Whether a meets less than b; of equal ones, whether it is later.
  bool is_worse(const ClaimResult& a, const ClaimResult& b) const;

 private:
  measures::MoveEvent event_;
  double
      late_;  ///< counts for a time that is never reached, s; of several goals as a part of what each allows
};

}  // namespace zerocount::tuning
