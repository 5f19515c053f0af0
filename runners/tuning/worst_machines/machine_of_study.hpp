#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// The machine of a study that does worst.
struct WorstMachine {
  std::int64_t rig{0};    ///< or the trial, where no trials share a rig
  std::int64_t trial{0};  ///< its worst trial
  double met{0.0};        ///< proportion of its moves that meet the goal
  std::vector<std::pair<std::string, double>> inputs;
  /// The goal that it meets in the fewest of its moves, and the condition: of these trial and met are.
  ClaimPlace claim{};
  std::optional<std::string> goal{}, condition{};  ///< their names; of one goal, and without conditions none
};

/// The machine with the fewest moves that meet a goal under a condition; of equal ones the one with the
/// largest criterion.
/// @param results of all units of the study
WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const UnitResult> results);

/// Names the goal and the condition of the machine's claim.
void name_claim(const study::Study& study, WorstMachine& machine);

}  // namespace zerocount::tuning
