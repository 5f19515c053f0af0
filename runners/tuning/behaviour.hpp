#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/summary/move_behaviour.hpp"
#include "runners/tuning/units/loop_examiner.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// How the moves of the first `count` units are made, each with one trial under each condition. The torque at
/// rest is measured from the dwell within `verdict.rest_band` on; where the study does not measure it, within
/// the largest band or tolerance of its goals.
/// @throws trial::Interrupted, trials::Spent
std::vector<summary::MoveBehaviour> simulated_behaviour(const study::Study& study,
                                                        const trials::Replicates& units, std::int64_t count,
                                                        const trials::Effort& effort);

/// Something that a drive engineer refuses, although the goals do not forbid it.
struct Refusal {
  std::string finding;  ///< "overshoot", "saturation", "phase margin", "torque noise"
  std::string text;     ///< "95 % of the moves of goal 'large' overshoot by up to 59 % of the step"
  double value{0.0};
  double largest{0.0};  ///< that passes; of the phase margin the smallest
  std::string remedy;   ///< "limits: {overshoot: 50}", as it stands in a manifest
};

/// Overshoot of more than 25 % of the step in 5 % of the moves (where it leaves the goal's band), a converter
/// that clips in more than 1 % of the moves, a phase margin below 30°, a torque whose changes at rest have an
/// rms of more than a tenth of the converter's largest torque.
std::vector<Refusal> refusals_of(const std::vector<summary::MoveBehaviour>& behaviour,
                                 const std::optional<SmallestMargins>& margins, const study::Study& study);

}  // namespace zerocount::tuning
