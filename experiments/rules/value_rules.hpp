#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/parameters/handles.hpp"
#include "experiments/study/point_edit.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::rules {

/// An inconsistency between values of parameters at a design point, as two phrases for a message.
struct ValueFault {
  std::string what;
  std::string expected;
  /// Indices of the involved values of the list that defines the moves (such as the targets); the message
  /// names the first one. Empty: only the parameters of the rule are involved.
  std::vector<std::size_t> listed{};
};

using study::Ranges;

/// A condition on the ranges of several parameters at a design point, which a manifest must meet.
struct ValueRule {
  using FindFaults =
      std::function<std::vector<ValueFault>(const Ranges& of, std::span<const study::ParameterRange> list)>;

  /// Parameters that the rule relates; the first one gives the path of the message.
  std::vector<parameter::Handle> between;
  /// The rule also involves all values of the list that defines the moves (targets, torque levels).
  bool whole_list{false};
  /// Finds faults from the ranges of the parameters, and of the values of the list if `whole_list` is set.
  FindFaults find_faults;
  bool warn_only{false};
  /// Only the first fault at any design point is reported, at a parameter of the rule that the manifest
  /// gives.
  bool once{false};
  /// The message is about the key of the recorded torque or reference, record_key(), which is not a
  /// parameter.
  bool of_record{false};
};

/// A rule that relates the given parameters, without the list that defines the moves.
inline ValueRule between(std::vector<parameter::Handle> parameters,
                         std::function<std::vector<ValueFault>(const Ranges& of)> find_faults) {
  return {std::move(parameters), false,
          [find = std::move(find_faults)](const Ranges& of, const auto&) { return find(of); }};
}

inline ValueRule warning(ValueRule rule) {
  rule.warn_only = true;
  return rule;
}

/// Default duration of the move (`hold`, s) of a study with a recorded reference: the duration of the record,
/// for the longest sample time of the values outside the sweep.
double hold_of_the_reference(const study::StudyPlan& plan);

/// Dotted path of the key with the recorded torque or reference, which replaces torque levels or targets.
std::string_view record_key(const study::StudyPlan& plan);

/// The rules between the values of the list that defines the moves and the parameters of the command: the
/// number of samples of a trial; of a sequence, the order of its targets; with a profile, the time that the
/// reference travels; of torque levels, the range of the converter.
std::vector<ValueRule> command_rules(const study::StudyPlan& plan);

/// The consistency rules between the values of other lists: the elements of the generalised Maxwell-slip
/// model, and filters.
std::vector<ValueRule> list_rules(const study::StudyPlan& plan);

/// The consistency rules for a study whose controller is a plugin.
std::vector<ValueRule> plugin_rules(const study::StudyPlan& plan);

/// All consistency rules between parameters for a study like this one.
std::vector<ValueRule> value_rules(const study::StudyPlan& plan);

/// The fault that the time `within` (s) of a goal is longer than a move with this range of the hold (duration
/// of a move, s); empty if there is none.
std::vector<ValueFault> longer_than_the_move(double within, const study::ParameterRange& hold);

/// The first inconsistency between the values of a design point that is an error, "path: what; expected …";
/// empty if there is none.
std::string first_fault(const study::StudyPlan& plan, std::size_t point);

/// Message why a study with the values at the edited point cannot be simulated: the first value outside its
/// range, or first_fault(). Empty if it can be simulated.
std::string refusal_of(const study::PointEdit& edit);

// Values that are allowed but absurd, such as an inertia in g m² that stands where kg m² are expected. Each
// test compares a dimensionless number of the typical values of a design point (medians of distributions,
// means of profiles) with a bound that no real axis comes near. All are warnings, reported once.

/// Warnings about an implausible natural frequency of the mass on the friction spring: plausible are some Hz
/// up to half the sample rate.
std::vector<ValueRule> plausible_dynamics(const study::StudyPlan& plan);

/// Warnings about implausible pre-sliding: the spring should soften before it slides, and yield by more than
/// a few counts.
std::vector<ValueRule> plausible_contact(const study::StudyPlan& plan);

/// Warnings about a delay of the loop that is probably in a wrong unit, such as seconds or microseconds.
std::vector<ValueRule> plausible_delay(const study::StudyPlan& plan);

/// Warnings about implausible gains: the torque for one count of error should be within the range of the
/// converter.
std::vector<ValueRule> plausible_gains(const study::StudyPlan& plan);

/// All rules that warn about implausible values.
std::vector<ValueRule> plausibility_rules(const study::StudyPlan& plan);

/// A rule that warns once, at the first of these parameters that the manifest gives.
ValueRule plausible(std::vector<parameter::Handle> parameters,
                    std::function<std::vector<ValueFault>(const Ranges& of)> find_faults);

/// The parameter that sets the resolution of the fine encoder in this study.
parameter::Handle fine_encoder(const study::StudyPlan& plan);

/// Resolution Δx of the fine encoder, rad or m.
/// @param encoder typical value of the parameter fine_encoder()
double typical_count(const study::StudyPlan& plan, double encoder);

/// A rule that keys of the manifest have an effect only under a condition. A given key is reported if the
/// condition holds at no design point.
struct EffectRule {
  std::vector<std::string_view>
      keys{};  ///< dotted paths of parameters, or of sections (all their parameters)
  std::vector<std::string_view> except{};       ///< parameters among `keys` to which the rule does not apply
  std::vector<parameter::Handle> depends_on{};  ///< parameters that decide whether the keys have an effect
  /// Whether the keys have an effect, from the ranges of the parameters `depends_on`.
  std::function<bool(const Ranges&)> has_effect{};
  std::string what{};       ///< first phrase of the message: what is wrong with a key that has no effect
  std::string expected{};   ///< second phrase of the message: what to write instead; empty for a warning
  bool off_at_zero{false};  ///< a key of the rule whose value is 0 at all design points is not reported
  bool warn_only{false};
};

/// The rules about keys without effect for a study like this one. If several rules match a key, the first
/// violated one is reported.
std::vector<EffectRule> effect_rules(const study::StudyPlan& plan);

/// Whether the rule about an effect applies to the parameter with this dotted path.
bool covers(const EffectRule& rule, std::string_view name);

/// Whether the keys of the rule have an effect at some design point. True if a value could not be read.
bool can_have_effect(const study::StudyPlan& plan, const EffectRule& rule);

/// Whether the parameter with this dotted path has an effect at some design point according to all given
/// rules.
bool has_effect(const study::StudyPlan& plan, std::span<const EffectRule> rules, std::string_view name);

}  // namespace zerocount::rules
