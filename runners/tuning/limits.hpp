#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// Rate of the goal with a cause of failures switched off: of several goals and conditions that of the worst.
struct Limit {
  std::string cause;
  std::optional<double> rate{};  ///< empty if it cannot be simulated, for the reason in `note`
  std::string note{};            ///< what the rate does not show
  Estimate estimate{};           ///< that the rate is of
  /// Of several goals and conditions: the worst ones, which the rate is of, and each with its rate.
  std::optional<std::string> goal{}, condition{};
  std::optional<std::vector<std::pair<std::string, double>>> rates{};
};

/// Whether less is known to be met; least of all where nothing could be simulated.
bool is_lower(const Limit& a, const Limit& b);
/// Whether no move, or machine, misses any goal under any condition.
bool misses_nothing(const Limit& limit);

/// The estimate on the first `count` units.
/// @param change null: none
Estimate estimate_on(const study::Study& study, const trials::Replicates& units, std::int64_t count,
                     const Change* change, const trials::Effort& effort);

/// Rates of the goal on all units, with each cause of failures switched off that a trial of the point can
/// have, and with the best pair of them, if that is better than each alone. The first entry is "none". A
/// change that makes a study which its manifest could not describe is not simulated.
///
///     for each cause, or pair:
///       for each condition: the study under it alone, with the cause switched off, on the same draws
///       rate = that of the worst goal under its worst condition
///
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> limits_of(const study::Study& study, const trials::Replicates& units,
                             const trials::Effort& effort);

}  // namespace zerocount::tuning
