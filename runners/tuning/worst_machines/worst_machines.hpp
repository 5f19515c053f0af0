#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "experiments/study/study.hpp"
#include "runners/tuning/worst_machines/judged_machine.hpp"
#include "runners/tuning/worst_machines/machine_of_study.hpp"

namespace zerocount::tuning {

/// The worst machines of a point.
struct WorstMachines {
  WorstMachine of_study;  ///< by its trials in the study
  JudgedMachine again;    ///< the same machine, judged as the others are
  /// Of all whose drawn quantities are each within their central 99.9 %, or else of the study: its corners
  /// may be machines that nobody builds.
  JudgedMachine in_box;
  bool in_box_is_of_study{false};
  /// Of those of the box whose normal scores have Σ z² ≤ the 99.9 % quantile of χ², without correlations.
  JudgedMachine likely;
  bool likely_is_in_box{false};  ///< both are the same machine
  bool with_profiles{false};     ///< the machines have profiles of their rigs
};

/// Finds the machines with the fewest moves that meet the goals; of equal ones the one whose moves have the
/// larger score (measures::MoveScore::event, that of `rare` too). The search in the box begins at the worst
/// machines of the study, at the corners, and at points that fill the box. With conditions it is made under
/// each, and the answer is of the worst.
///
///     race of some machines, on the same random numbers: 4 trials each; a quarter goes on to 16, of it a
///       quarter to 64 trials; the 8 worst are kept
///     population = race of the first machines
///     8 times: population = race of it and of 32 children, each near a machine of the population; a child
///     goes
///       on only while it does worse than one of the population on the same trials
///     likely machines: only where a machine of the box misses a move
///     the worst is judged by 256 trials of its own
///
/// @param folder from which the study's manifest names its files; none if it is not a file
/// @throws trial::Interrupted, trials::Spent; Failure (bad_input) if the study draws nothing that differs
/// between machines
WorstMachines worst_machines(const study::Study& study, const trials::Replicates& units,
                             const std::optional<std::filesystem::path>& folder,
                             const trials::Effort& effort);

/// Trials that worst_machines() runs, about.
std::int64_t trials_of_worst_machines(const study::Study& study, const trials::Replicates& units);

}  // namespace zerocount::tuning
