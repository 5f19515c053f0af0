#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/tuning/effects/effect_runs.hpp"

namespace zerocount::tuning {

/// Rate of the goal with an effect switched off or added: of several goals and conditions that of the worst.
struct Limit {
  std::string effect;
  std::optional<double> rate{};  ///< empty if it is not simulated, for the reason in `note`
  std::string note{};            ///< what the rate does not show, or what is assumed
  Estimate estimate{};           ///< that the rate is of
  double asked{1.0};             ///< the rate that its goal asks for
  /// Of several goals and conditions: the worst ones, which the rate is of, and each with its rate.
  std::optional<std::string> goal{}, condition{};
  std::optional<std::vector<std::pair<std::string, double>>> rates{};
};

/// Whether less is known to be met; least of all where nothing was simulated.
bool is_lower(const Limit& a, const Limit& b);
/// Whether no move, or machine, misses any goal under any condition.
bool misses_nothing(const Limit& limit);

/// The row of a changed point, of the units that have run.
Limit limit_of(const EffectRuns& runs, const ChangedPoint& point);

/// The estimate on the first `count` units.
/// @param change null: none
Estimate estimate_on(const study::Study& study, const trials::Replicates& units, std::int64_t count,
                     const Change* change, const trials::Effort& effort);

/// Rates of the goal on all units, with each cause of failures switched off that a trial of the point can
/// have, and with the best pair of them, if that is better than each alone. The first entry is "none". A
/// change that makes a study which its manifest could not describe is not simulated, and none where nothing
/// is missed.
///
///     for each cause: the study under each condition with the cause switched off, on the same draws;
///       rate = that of the worst goal under its worst condition
///     pairs, on the first 1/8 of the units (64 at least), then twice as many, … until all:
///       the better half goes on, and of it those that are on these units at least as good as each cause
///       alone
///
/// Of pairs whose rates are nearly equal another one may be the best.
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> limits_of(const EffectRuns& runs);

}  // namespace zerocount::tuning
