#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// Rate of the goal with a cause of failures switched off.
struct Limit {
  std::string cause;
  std::optional<double> rate{};  ///< empty if it cannot be simulated, for the reason in `note`
  std::string note{};            ///< what the rate does not show
};

/// Rate of the goal (Estimate::rate) on the first `count` units.
/// @param change null: none
double rate_of(const study::Study& study, const trials::Replicates& units, std::int64_t count,
               const Change* change, const trials::Effort& effort);

/// Rates of the goal on all units, with each cause of failures switched off that a trial of the point can
/// have, and with the best pair of them, if that is better than each alone. The first entry is "none". A
/// change that makes a study which its manifest could not describe is not simulated.
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> limits_of(const study::Study& study, const trials::Replicates& units,
                             const trials::Effort& effort);

}  // namespace zerocount::tuning
