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
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/race/candidate.hpp"

/// Sensitivity of a tuned answer: effects of the real axis, such as friction or noise, are switched off or
/// added one by one, at the same gains, and the success rates are compared.
namespace zerocount::tuning {

/// An effect of a real axis, such as encoder noise, and how to switch it off or add it in a study.
struct Effect {
  std::string name;
  std::string note{};     ///< Assumption of the change, or a limitation of its rate; empty: nothing to say.
  std::string refusal{};  ///< Reason why the change cannot be simulated; empty if it can.
  /// Changes the study's values at a design point, including values that depend on the changed ones. Empty:
  /// no value changes.
  std::function<void(study::PointEdit&)> edit{};
  Change change{};  ///< Changes the parameters of a trial after they are drawn. Empty: no change.
  /// Units in which the changed trials count and sample; they differ from the study's for a finer encoder or
  /// a higher sample rate.
  FinerUnits finer{};
};

/// A design point with some effects switched off or added, and the results of its first machines.
struct ChangedPoint {
  /// Names of the changed effects, joined by "and"; "none" without one.
  std::string name;
  /// [setting] Effects that are changed in the setting (condition at an age).
  std::vector<std::vector<Effect>> under;
  std::string note{};     ///< Note of the first changed effect that has one (Effect::note).
  std::string refusal{};  ///< Why the point cannot be simulated; empty if it can.
  /// [setting] Study in this setting alone, with the edits of the effects.
  std::vector<study::Study> studies{};
  std::vector<Change> changes{};    ///< [setting] Change of each trial's parameters after they are drawn.
  std::vector<FinerUnits> finer{};  ///< [setting] Units in which the changed trials count and sample.
  /// [machine] Results of the machines run so far, with all goals in all settings.
  std::vector<MachineResult> machines{};
};

/// Simulates a design point with effects switched off or added. All runs use the random numbers of the study.
/// Each setting (condition at an age) is run as a study of its own.
class EffectRuns {
 public:
  /// Simulates the unchanged design point on all machines.
  /// @throws trial::Interrupted if a stop is requested or the time is over
  /// @throws trials::Spent if the trials of `effort` are not enough
  EffectRuns(const study::Study& study, const trials::Replicates& machines, trials::Effort effort);

  const study::Study& study() const { return study_; }
  const Aim& aim() const { return aim_; }
  std::int64_t point() const { return machines_.point; }
  /// Number of machines on which points are simulated. If no trials share a machine, each draw counts as one.
  std::int64_t machines() const { return machines_.count; }
  /// Number of trials that each machine runs in one setting.
  std::int64_t trials_each() const { return machines_.trials_each; }
  /// [setting] The study restricted to this setting (condition at an age).
  const std::vector<study::Study>& settings() const { return settings_; }
  const trials::Effort& effort() const { return effort_; }
  /// The point without any change, with the results of all machines.
  const ChangedPoint& base() const { return base_; }
  /// Success rates and criterion of a point, estimated from the machines that have run so far.
  RateEstimate estimate(const ChangedPoint& point) const {
    return estimate_of(aim_, point.machines, machines_.count);
  }

  /// Makes one changed point for each effect name. In it, this effect alone is changed, in all settings that
  /// have it. No machine of the points has run yet. If the manifest could not describe a point, its refusal
  /// says why.
  /// @param effects_of returns the effects of a study in one setting, at a design point
  std::vector<ChangedPoint> points(
      const std::function<std::vector<Effect>(const study::Study&, std::int64_t)>& effects_of) const;
  /// The point in which the effects of `a` and those of `b` are changed. No machine of it has run yet.
  ChangedPoint together(const ChangedPoint& a, const ChangedPoint& b) const;

  /// Simulates each point until it has the results of `count` machines. All points run together. Skips points
  /// that cannot be simulated (ChangedPoint::refusal).
  /// @throws trial::Interrupted if a stop is requested or the time is over
  /// @throws trials::Spent if the trials of the effort are not enough
  void run(std::span<ChangedPoint> points, std::int64_t count) const;

 private:
  void apply_effects(ChangedPoint& point) const;
  void run_all(std::span<ChangedPoint> points, std::int64_t count) const;

  const study::Study& study_;
  Aim aim_;
  trials::Replicates machines_;  ///< Machines of the study, with their trials in one setting.
  trials::Effort effort_;
  std::vector<study::Study> settings_;
  ChangedPoint base_;
};

/// Maximum probability of naming a cause of failures, or a pair of causes, if nothing that is switched off
/// truly raises the success rate.
inline constexpr double max_false_cause = 0.05;

/// Paired comparison of the same machines before and after a change, on the same random numbers. If no trials
/// share a machine, each trial counts as one.
struct PairedGain {
  std::int64_t machines{0};  ///< Number of machines that are compared before and after the change.
  /// Number of machines that meet the claim in more of their moves after the change.
  std::int64_t gained{0};
  std::int64_t lost{0};  ///< Number of machines that meet the claim in fewer of their moves after the change.
  /// One-sided p-value of the sign test: probability of at least this many gains among the machines that
  /// differ, if gain and loss were equally likely. If a machine either meets the claim or not, this is
  /// McNemar's exact test.
  double p_value{1.0};
  /// Whether the gain is significant: p_value is at most max_false_cause / 2, divided by the number of
  /// alternatives (Bonferroni). Causes and pairs of causes have one half of max_false_cause each.
  bool shown{false};
};

/// Compares two points on their common machines in one claim (a goal in a setting).
/// @param number index of the claim in Aim::claims
/// @param before results of the machines without the change
/// @param after results of the same machines with the change
/// @param alternatives number of causes, or of pairs of causes, that are tried
PairedGain paired_gain(const study::Goal& claim, std::size_t number, std::span<const MachineResult> before,
                       std::span<const MachineResult> after, std::int64_t alternatives);

/// Smallest number of machines with which a paired comparison can show a gain, if all of them gain.
/// @param alternatives number of causes, or of pairs of causes, that are tried
std::int64_t machines_to_show_a_gain(std::int64_t alternatives);

/// Result with an effect switched off or added: success rate and its comparison with the unchanged point.
/// With several goals or settings, the rate is that of the worst goal in its worst setting.
struct Limit {
  std::string effect;
  /// Success rate with the change, 0 to 1; nothing if it was not simulated, for the reason in `note`.
  std::optional<double> rate{};
  /// Assumption of the change, or a limitation of its rate; without a rate, why it was not simulated.
  std::string note{};
  /// Estimate of the success rates from the simulated machines; `rate` is taken from it.
  RateEstimate estimate{};
  double asked{1.0};  ///< Rate that the worst claim (goal in a setting) asks for.
  bool holds{false};  ///< Whether the simulated machines meet every goal in every setting.
  /// Fraction of the unchanged point's failures that the change avoids, 0 to 1; negative if failures
  /// increase. Set only if both rates describe the same goal and setting, on equally many machines.
  std::optional<double> avoided{};
  /// Names of the worst goal and setting (condition at an age), which the rate describes. Set if there are
  /// several goals or any setting.
  ClaimNames worst{};
  /// Name and success rate of each claim (goal in a setting). Set if there are several goals or any setting.
  std::optional<std::vector<std::pair<std::string, double>>> rates{};
  /// Numbers of machines that gain or lose when a cause is switched off, in the claim (goal in a setting)
  /// that is worst without changes. The gain counts as shown only if the rate rises too. Nothing for effects
  /// that are not causes.
  std::optional<PairedGain> gain{};

  bool is_shown_cause() const { return gain && gain->shown; }
};

/// Callback that gets the name of the running stage, for the status line on the terminal.
using TellStage = std::function<void(const std::string&)>;

/// Whether the result `a` ranks below `b`, because its RateEstimate::margin is smaller. A result that was not
/// simulated ranks below all others.
bool is_lower(const Limit& a, const Limit& b);
/// Whether no simulated move, or machine, misses any goal in any setting.
bool misses_nothing(const Limit& limit);

/// Success rate of a changed point from the machines that have run, with the names of the worst goal and
/// setting.
Limit limit_of(const EffectRuns& runs, const ChangedPoint& point);

/// Simulates the first `count` machines of a study, and estimates the success rates from them.
/// @param change changes the parameters of each drawn trial; null: no change
RateEstimate estimate_on(const study::Study& study, const trials::Replicates& machines, std::int64_t count,
                         const Change* change, const trials::Effort& effort);

/// Success rates on all machines with each possible cause of failures switched off, and with the best pair of
/// causes, if the pair is better than each single cause. The first entry is "none", the unchanged point. A
/// change is not simulated if no manifest could describe the changed study. Nothing is switched off if no
/// goal is missed. Pairs are left out if the effort ends before.
///
///     for each cause: the study in each setting with the cause switched off, on the same draws;
///       rate = rate of the worst goal in its worst setting; paired_gain() in the goal that is missed
///     pairs of causes, on the first 1/8 of the machines (64 to 1024), then twice as many, … until all:
///       keep the better half of the pairs, and of this half the pairs that are at least as good on these
///       machines as each single cause
///     the best pair is a cause if paired_gain() shows that it is better than the unchanged point and than
///       the best single cause
///
/// If several pairs have nearly equal rates, another pair may be the best one.
/// @param tell gets the name of the running stage
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> find_causes(const EffectRuns& runs, const TellStage& tell = {});

/// Approximate cost of find_causes(), in units of one simulation of all `machines` machines.
/// @param point index of the design point
double runs_of_causes(const study::Study& study, std::int64_t point, std::int64_t machines);

/// The cause, or pair of causes, with the highest success rate among those whose gain is significant; null if
/// no gain is significant.
const Limit* main_cause(const std::vector<Limit>& limits);

/// The causes of failures that a trial of the point can have, each to be switched off:
///
///   - each parameter whose value differs from its ideal value (parameters::Ideal)
///   - friction that varies along the track, or from contact to contact; each spectrum of the disturbance
///   - idealisations of several values: a rigid axis or a stiffer coupling, no constant disturbance, no
///     ripple (each with what holds it at the start), each filter, the integral under friction, a
///     feed-forward that fits the axis, a faster profile, a finer converter, a wider torque range, a finer
///     encoder, twice the sample rate
///
/// Each effect changes one thing. If the point does not have an effect, the list lacks it, or switching it
/// off leaves the rate as it is.
std::vector<Effect> idealisations_of(const study::Study& study, std::int64_t point);

/// Names of the manifest sections with parameters that have no ideal value. Other values of these parameters
/// are not tried as causes.
std::vector<std::string> sections_with_other_values();

/// Effects of a real axis to add to the point. They are one more sample of delay, and encoder noise of 0.1
/// counts rms, added in quadrature to the noise of each encoder that closes the loop.
std::vector<Effect> added_effects(const study::Study& study, std::int64_t point);

/// Effect that adds a second mass behind a spring (theory::with_load_mode), so that the axis has a mode at
/// this natural frequency, Hz.
Effect load_mode(const study::Study& study, std::int64_t point, double frequency);

/// Success rates with each of added_effects(). If the study has no second mass, also the rate with the lowest
/// load mode that costs every goal at most 1 % in every setting. All runs use the random numbers of the
/// study.
///
///     borne(f, machines): each rate with a mode at f ≥ the rate without it − 1 %, on the same machines
///     f = half the sample rate; halve f while it is borne on few machines; bisect to 5 %
///     change f in steps of 5 % until it is the lowest that is borne on more machines; return its rate
///
/// A load mode takes ten times as long to simulate as a rigid axis. So the mode is judged on the first
/// machines that have 800 000 samples together, and sought on 1/8 of them. On these few, one more machine may
/// miss. A frequency is given up as soon as no result of the other machines could save it. Nothing is
/// simulated if at most 1 % of the moves, or machines, meet each goal.
/// @param tell gets the name of the running stage
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> additions_to(const EffectRuns& runs, const TellStage& tell = {});

/// Effects that change premises of a point: twice the spread of all drawn quantities of the axis
/// (study::PointEdit::widen), if there are any; half the delay; and twice the delay. A point without delay
/// gets half a sample and two samples instead.
std::vector<Effect> other_premises(const study::Study& study, std::int64_t point);

/// Success rates on all machines with other premises. The first entry is the lowest rate with ten other
/// seeds. Then follow the rates with each of other_premises().
/// @param runs runs of the unchanged study
/// @param machines machines of the unchanged study
/// @param with_seed returns the study with another seed
/// @throws trial::Interrupted, trials::Spent
std::vector<Limit> variations_of(const EffectRuns& runs, const trials::Replicates& machines,
                                 const std::function<study::Study(std::uint64_t seed)>& with_seed);

}  // namespace zerocount::tuning
