#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "analysis/comparison/point_trials.hpp"

namespace zerocount::testing {

/// How the made-up trials of a design point turn out.
struct SyntheticPoint {
  double success{0.9};    ///< probability
  double settling{0.03};  ///< mean of the settling times, s: they come in samples of 0.5 ms
  double jerks{0.5};      ///< mean number of jerks of a trial, most of which have none
};

/// What chance gives a trial, shared by all points as a study's draws are.
using TrialChances = std::vector<std::vector<double>>;  ///< [trial][quantity], uniform

TrialChances draw_chances(std::mt19937_64& random, std::int64_t trials);

/// Chances of which each trial keeps those of `chances`, or, with probability `change`, has new ones: the
/// same trials by another build whose outcomes differ here and there.
TrialChances redraw_some(std::mt19937_64& random, const TrialChances& chances, double change);

comparison::PointTrials synthetic_trials(const SyntheticPoint& point, const TrialChances& chances);

}  // namespace zerocount::testing
