#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/point_edit.hpp"
#include "runners/tuning/race/candidate.hpp"
#include "runners/tuning/units/unit_runner.hpp"

/// What a tuned answer rests on: its premises changed one by one, at the same gains.
namespace zerocount::tuning {

/// An effect of a real axis, and a study without it, or with it added.
struct Effect {
  std::string name;
  std::string note{};     ///< what is assumed, or what the rate does not show
  std::string refusal{};  ///< why it cannot be simulated; empty if it can
  /// The values to change, those that belong to them included; empty: none.
  std::function<void(study::PointEdit&)> edit{};
  Change change{};     ///< of what a trial has drawn; empty: none
  FinerUnits finer{};  ///< Units of the changed trials.
};

/// A point with some effects switched off or added, and what its first units do.
struct ChangedPoint {
  std::string name;                        ///< of the effects, joined by "and"; "none"
  std::vector<std::vector<Effect>> under;  ///< [condition] the effects that are changed
  std::string note{};                      ///< of the first effect that has one
  std::string refusal{};                   ///< why it cannot be simulated; empty if it can
  std::vector<study::Study> studies{};     ///< [condition]
  std::vector<Change> changes{};           ///< [condition], after the trials of these studies are drawn
  std::vector<FinerUnits> finer{};         ///< [condition] Units of these trials.
  std::vector<UnitResult> units{};         ///< so far, with all goals under all conditions
};

/// Runs a point with effects switched off or added on the random numbers of the study, each condition as a
/// study of its own.
class EffectRuns {
 public:
  /// Runs the point as it is.
  /// @throws trial::Interrupted, trials::Spent
  EffectRuns(const study::Study& study, const trials::Replicates& units, trials::Effort effort);

  const study::Study& study() const { return study_; }
  const Aim& aim() const { return aim_; }
  std::int64_t point() const { return units_.point; }
  /// Units of the study, and trials of each under one condition.
  std::int64_t units() const { return units_.count; }
  std::int64_t trials_each() const { return units_.trials_each; }
  const std::vector<study::Study>& conditions() const { return conditions_; }
  const trials::Effort& effort() const { return effort_; }
  /// The point as it is, with the results of all units.
  const ChangedPoint& base() const { return base_; }
  /// By the units that have run.
  Estimate estimate(const ChangedPoint& point) const { return estimate_of(aim_, point.units, units_.count); }

  /// The point with each of these effects changed alone, under all conditions that have an effect of the
  /// name. Nothing has run. Where the manifest could not describe one, its refusal says why.
  /// @param effects_of a study under a condition, and its point
  std::vector<ChangedPoint> points(
      const std::function<std::vector<Effect>(const study::Study&, std::int64_t)>& effects_of) const;
  /// The point with the effects of both.
  ChangedPoint together(const ChangedPoint& a, const ChangedPoint& b) const;

  /// Runs the units of each point up to `count`, all of them in one go, and passes over points that cannot be
  /// simulated.
  /// @throws trial::Interrupted, trials::Spent
  void run(std::span<ChangedPoint> points, std::int64_t count) const;

 private:
  void apply_effects(ChangedPoint& point) const;
  void run_all(std::span<ChangedPoint> points, std::int64_t count) const;

  const study::Study& study_;
  Aim aim_;
  trials::Replicates units_;  ///< of each condition
  trials::Effort effort_;
  std::vector<study::Study> conditions_;
  ChangedPoint base_;
};

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
  bool holds{false};             ///< every goal is met under every condition by these units
  /// Part of the failures of the point as it is that are avoided, where these are of the same goal and
  /// condition, and units.
  std::optional<double> avoided{};
  /// Of several goals and conditions: the worst ones, which the rate is of, and each with its rate.
  ClaimNames worst{};
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

/// The causes of failures that a trial of the point can have, each to be switched off:
///
///   - each parameter that has not its ideal value (parameters::Ideal)
///   - friction that varies along the track, or from contact to contact; each spectrum of the disturbance
///   - idealisations of several values: a rigid axis or a stiffer coupling, no constant disturbance, no
///     ripple (each with what holds it at the start), each filter, the integral under friction, a
///     feed-forward that fits the axis, a faster profile, a finer converter, a wider torque range, a finer
///     encoder, twice the sample rate
///
/// Each changes one thing. Where a point is without the effect, its row is absent or has the rate of the
/// point.
std::vector<Effect> idealisations_of(const study::Study& study, std::int64_t point);

/// The sections of manifests with parameters that have no ideal value: other values of these are not tried.
std::vector<std::string> sections_with_other_values();

/// Effects of a real axis that are added to those of the point: encoder noise of 0.1 counts rms, in
/// quadrature to that of each encoder that closes the loop, and one sample of delay.
std::vector<Effect> added_effects(const study::Study& study, std::int64_t point);

/// A mode of the load at this natural frequency (Hz): theory::with_load_mode.
Effect load_mode(const study::Study& study, std::int64_t point, double frequency);

/// Rates of the goal with each of these effects added, and, if the study has no second mass, with the lowest
/// mode of a load that costs no goal under any condition more than 1 %. All on the random numbers of the
/// study.
///
///     borne(f, units): rates with a mode at f ≥ those without it − 1 %, on the same units
///     f = half the sample rate; by halves while borne on few units; bisected to 5 %
///     in steps of 5 % to the lowest that is borne on more units, whose rate is given
///
/// A mode takes ten times as long to simulate as a rigid axis, so these are the first units with 800 000
/// samples together, and the few are 1/8 of them; there one missing unit more is allowed. A frequency is
/// given up as soon as no result of the other units could save it. Nothing is simulated where every goal is
/// met by 1 % at most.
/// @param tell gets what is being simulated
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> additions_to(const EffectRuns& runs, const TellStage& tell = {});

/// Effects that change premises of a point: twice the spread of all that is drawn of the axis
/// (study::PointEdit::widen), if anything is; and half and twice the delay, or half a sample and two where it
/// has none.
std::vector<Effect> other_premises(const study::Study& study, std::int64_t point);

/// The rates with ten other seeds, of which the lowest counts, and with each of the other premises, on all
/// units.
/// @param runs of the study as it is. @param units of it
/// @param with_seed the same study with another seed
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> variations_of(const EffectRuns& runs, const trials::Replicates& units,
                                 const std::function<study::Study(std::uint64_t seed)>& with_seed);

}  // namespace zerocount::tuning
