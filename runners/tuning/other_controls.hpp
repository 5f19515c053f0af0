#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.hpp"

namespace zerocount::tuning {

/// Another control for the same axis.
struct OtherControl {
  std::vector<std::string> zero;             ///< free parameters of the study that are 0
  std::vector<std::string> overrides;        ///< "key=value", these zeros among them
  std::vector<study::FreeParameter> free{};  ///< to be tuned
};

/// The controls that a tuning is compared with: kp or kd at 0 where their ranges begin there, both, and a
/// disturbance observer beside the PID law where the study has none.
std::vector<OtherControl> other_controls(const study::Study& study);

}  // namespace zerocount::tuning
