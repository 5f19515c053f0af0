#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "tests/analysis/record/sliding_identification/joint_records.hpp"

namespace zerocount::testing {

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline double log_uniform(std::mt19937_64& random, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution<double>()(random));
}

inline sliding_identification::SlidingIdentification identified(const JointMotion& motion,
                                                                std::mt19937_64& random) {
  return sliding_identification::identify_sliding({sliding_identification::sliding_record(
      joint_record(motion.joint, motion.targets, motion.speed, random))});
}

/// The estimate of the parameter with this name; null if there is none.
inline const fit::ParameterEstimate* estimate(const sliding_identification::SlidingIdentification& found,
                                              const std::string& name) {
  const auto place = std::ranges::find(found.parameters, name, &fit::ParameterEstimate::name);
  return place == found.parameters.end() ? nullptr : &*place;
}

/// Number of successes out of `count` with probability 0.95 that is exceeded in 99.9 % of the cases.
inline double least_expected(int count) {
  return 0.95 * count - 3.1 * std::sqrt(0.95 * 0.05 * count) - 0.5;
}

}  // namespace zerocount::testing
