#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {

/// Another control for the same axis.
struct OtherControl {
  std::string name;                          ///< "controller.kd = 0", "observer added"
  std::vector<std::string> zero;             ///< free parameters of the study that are 0
  std::vector<std::string> overrides;        ///< "key=value", these zeros among them
  std::vector<study::FreeParameter> free{};  ///< to be tuned
};

/// The sets of free parameters that can be 0 together, each a control with fewer blocks: kp or kd where their
/// ranges begin there, and both. Some parameter stays free in each.
std::vector<std::vector<std::size_t>> zero_sets(std::span<const study::FreeParameter> free);

/// The controls that a tuning is compared with: kp or kd at 0 where their ranges begin there, both, and a
/// disturbance observer beside the PID law where the study has none. Those with fewer free parameters come
/// first.
std::vector<OtherControl> other_controls(const study::Study& study);

/// The values of a tuned control by the names of its parameters, those that it fixes included.
using TunedValues = std::map<std::string, double>;

/// Starts of the search for a control: each tuned control, where this one has all its blocks with the added
/// ones nearly without effect, so that this control is worse than the other only by chance; else what it has
/// of the other.
/// @param free parameters of the control. An observer has nearly no effect at the low end of its bandwidth.
std::vector<Values> starts_from(std::span<const TunedValues> tuned,
                                std::span<const study::FreeParameter> free);

}  // namespace zerocount::tuning
