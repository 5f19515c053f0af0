#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// Rate of the goal with an effect of a real axis added to those that the study has.
struct Addition {
  std::string effect;
  std::optional<double> rate{};
  std::string note{};  ///< what is assumed, or found
};

/// Rates of the goal on all units: with encoder noise added, with one sample of delay more, and, if the study
/// has no second mass, with the lowest mode of a load that the goal bears.
///
///     mode: half of the inertia is behind a coupling, of 1 % damping; encoder on the motor
///     lowest frequency f from half the sample rate down, with a rate of at least that without it − 1 %:
///       f ← f/2 until it is not borne, or below the lowest that is tried; then bisected to 5 %
///
/// The same random numbers stand in all of them.
/// @param rate of the goal as the study is
/// @throws trial::Interrupted, trials::Spent
std::vector<Addition> additions_to(const study::Study& study, const trials::Replicates& units, double rate,
                                   const trials::Effort& effort);

}  // namespace zerocount::tuning
