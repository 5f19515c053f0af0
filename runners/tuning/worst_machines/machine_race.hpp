#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/measures/move_event.hpp"
#include "core/trial/outcome.hpp"
#include "runners/trials/effort.hpp"
#include "runners/tuning/worst_machines/machine_box.hpp"

namespace zerocount::tuning {

/// The claim that the unit meets in the fewest moves, the latest of equal ones.
std::size_t worst_claim(const UnitResult& unit);
const ClaimResult& worst_result(const UnitResult& unit);

/// The worst unit: by its worst claim.
std::size_t worst_unit(std::span<const UnitResult> units);

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

/// Trials of a machine at each stage of a race, from its first one on: the last stage decides.
constexpr std::array<std::int64_t, 3> stage_trials{4, 16, 64};
/// Machines that a race keeps.
constexpr std::size_t survivors = 8;

/// Keeps the worst of the points, the worst first. After each stage a part of those that have not run all
/// trials goes on, by the trials that all of them have run: of it those that do worse there than the mildest
/// point that is kept so far, which they would replace.
/// @throws trial::Interrupted, trials::Spent
void race(std::vector<BoxPoint>& points, const MachineBox& box, const MachineFailures& failures,
          const trials::Effort& effort);

}  // namespace zerocount::tuning
