#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "experiments/study/study.hpp"

namespace zerocount::summary {

/// In how many moves that miss a goal, and in how many that meet it, the converter clipped.
struct SaturatedMoves {
  std::int64_t missed{0}, missed_saturated{0};
  std::int64_t met{0}, met_saturated{0};

  double of_missed() const { return static_cast<double>(missed_saturated) / static_cast<double>(missed); }
  double of_met() const { return static_cast<double>(met_saturated) / static_cast<double>(met); }
};

/// A goal of a study at a design point under a condition.
struct JudgedClaim {
  std::int64_t point;
  std::size_t goal;
  std::size_t condition;
};

/// The moves of a results file that the claim is about; nothing where the file does not keep every trial.
std::optional<SaturatedMoves> saturated_moves(const std::filesystem::path& path, const study::Study& study,
                                              const JudgedClaim& claim);

/// "of the 80 moves that miss the goal 78 saturate the converter, of the 20 others 1: …"; empty unless most
/// of the moves that miss it saturate, and more of them than of the others.
std::string saturation_sentence(const SaturatedMoves& moves);

}  // namespace zerocount::summary
