#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/race/candidate.hpp"

namespace zerocount::tuning {

/// The machine of a study that does worst.
struct WorstMachine {
  std::int64_t rig{0};    ///< or the trial, where no trials share a rig
  std::int64_t trial{0};  ///< its worst trial
  double met{0.0};        ///< proportion of its moves that meet the goal
  std::vector<std::pair<std::string, double>> inputs;
};

/// The machine with the fewest moves that meet the goal; of equal ones the one with the largest criterion.
/// @param results of all units of the study
WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const UnitResult> results);

}  // namespace zerocount::tuning
