#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runners/tuning/effects/effect_runs.hpp"
#include "runners/tuning/race/candidate.hpp"

namespace zerocount::tuning {

/// Probability at most of naming a cause, or a pair of causes, where nothing that is tried raises the rate.
inline constexpr double max_false_cause = 0.05;

/// Units that meet a claim in more of their moves after a change than before it, and in fewer, on the same
/// draws. A unit is a machine, or a trial where no trials share a machine.
struct PairedGain {
  std::int64_t units{0};  ///< that are compared
  std::int64_t gained{0};
  std::int64_t lost{0};
  /// Probability of as many gained, of those that differ, if each were as likely to lose: the sign test,
  /// which is McNemar's exact test where a unit meets the claim or not.
  double p_value{1.0};
  bool shown{false};  ///< below a half of max_false_cause, divided by the number of alternatives (Bonferroni)
};

/// @param number of the claim in Aim::claims @param alternatives causes, or pairs of causes, that are tried
PairedGain paired_gain(const Claim& claim, std::size_t number, std::span<const UnitResult> before,
                       std::span<const UnitResult> after, std::int64_t alternatives);

/// The smallest number of units that can show a gain: all of them gain.
std::int64_t units_to_show_a_gain(std::int64_t alternatives);

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
  /// Of a cause that is switched off: units that gain by it, of the goal that is the worst with nothing
  /// switched off. It is shown only where the rate rises too.
  std::optional<PairedGain> gain{};

  bool is_shown_cause() const { return gain && gain->shown; }
};

/// Gets what is being simulated, for people who wait.
using TellStage = std::function<void(const std::string&)>;

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
/// is missed; nor are pairs, if the effort ends before.
///
///     for each cause: the study under each condition with the cause switched off, on the same draws;
///       rate = that of the worst goal under its worst condition; paired_gain() in the goal that is missed
///     pairs, on the first 1/8 of the units (64 to 1024), then twice as many, … until all:
///       the better half goes on, and of it those that are on these units at least as good as each cause
///       alone
///     the best pair is a cause if paired_gain() shows that it is better than the point as it is, and than
///     the
///       best cause alone
///
/// Of pairs whose rates are nearly equal another one may be the best.
/// @param tell gets what is being simulated
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> limits_of(const EffectRuns& runs, const TellStage& tell = {});

/// About how often limits_of() runs so many units.
double runs_of_limits(const study::Study& study, std::int64_t point, std::int64_t units);

/// The cause, or pair of causes, that is shown to raise the rate most; null: none is shown.
const Limit* main_cause(const std::vector<Limit>& limits);

}  // namespace zerocount::tuning
