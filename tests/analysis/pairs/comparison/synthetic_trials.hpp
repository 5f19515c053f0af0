#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "analysis/pairs/comparison/point_trials.hpp"

namespace zerocount::testing {

/// Parameters of the made-up trials of a design point.
struct SyntheticPoint {
  double success{0.9};    ///< probability of success
  double settling{0.03};  ///< mean settling time, s; settling times are multiples of 0.5 ms
  double jerks{0.5};      ///< mean number of jerks in a trial; most trials have none
};

/// Uniform random numbers from which made-up trials follow. All design points share them, as they share the
/// draws of a study.
using TrialChances = std::vector<std::vector<double>>;  ///< [trial][quantity] uniform number

TrialChances draw_chances(std::mt19937_64& random, std::int64_t trials);

/// Random numbers for a second study: each trial keeps those of `chances`, or, with probability `change`,
/// gets new ones. They model the same trials run by another build, with a few different outcomes.
TrialChances redraw_some(std::mt19937_64& random, const TrialChances& chances, double change);

comparison::PointTrials synthetic_trials(const SyntheticPoint& point, const TrialChances& chances);

}  // namespace zerocount::testing
