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

/// An inconsistency between values at a design point.
struct ValueFault {
  std::string what;
  std::string expected;
  /// Indices of the involved values of the list; the message names the first one. Empty: only the parameters
  /// of the rule are involved.
  std::vector<std::size_t> listed{};
};

using study::Ranges;

/// A condition on the ranges of several parameters at a design point.
struct ValueRule {
  using FindFaults =
      std::function<std::vector<ValueFault>(const Ranges& of, std::span<const study::ParameterRange> list)>;

  std::vector<parameter::Handle> between;  ///< the parameters; the first one gives the path of the message
  bool whole_list{false};                  ///< the rule also involves all values of the list
  FindFaults find_faults;  ///< finds faults from the ranges of the parameters, and of the list if whole_list
  bool warn_only{false};
  bool once{false};  ///< only the first fault is reported, at a parameter of the rule that the manifest gives
  bool of_record{false};  ///< the message is about record_key(), which is not a parameter
};

/// A rule between the given parameters, without the list.
inline ValueRule between(std::vector<parameter::Handle> parameters,
                         std::function<std::vector<ValueFault>(const Ranges& of)> find_faults) {
  return {std::move(parameters), false,
          [find = std::move(find_faults)](const Ranges& of, const auto&) { return find(of); }};
}

inline ValueRule warning(ValueRule rule) {
  rule.warn_only = true;
  return rule;
}

/// Default of the hold (s) of a study with a recorded reference: the duration of the record, for the longest
/// sample time of the base values.
double hold_of_the_reference(const study::StudyPlan& plan);

/// The key of the record that replaces torque levels or targets.
std::string_view record_key(const study::StudyPlan& plan);

/// The rules between the values of the list and the parameters of the command: the number of samples of a
/// trial; of a sequence, the order of its targets; with a profile, the time that the reference travels; of
/// torque levels, the range of the converter.
std::vector<ValueRule> command_rules(const study::StudyPlan& plan);

/// The rules between the values of lists: the elements of the generalised Maxwell-slip model, and filters.
std::vector<ValueRule> list_rules(const study::StudyPlan& plan);

/// The rules for a study whose controller is a plugin.
std::vector<ValueRule> plugin_rules(const study::StudyPlan& plan);

/// All rules for a plan of this kind.
std::vector<ValueRule> value_rules(const study::StudyPlan& plan);

/// The rule that the time `within` (s) of a goal is not longer than a move with this range of the hold.
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

/// Rules for the natural frequency on the friction spring: from some Hz to half the sample rate.
std::vector<ValueRule> plausible_dynamics(const study::StudyPlan& plan);

/// Rules for pre-sliding: the spring softens before it slides, and yields by more than a few counts.
std::vector<ValueRule> plausible_contact(const study::StudyPlan& plan);

/// Rules that detect a delay of the loop in a wrong unit, such as seconds or microseconds.
std::vector<ValueRule> plausible_delay(const study::StudyPlan& plan);

/// Rules for gains: the torque for one count of error is within the range of the converter.
std::vector<ValueRule> plausible_gains(const study::StudyPlan& plan);

/// All rules about implausible values.
std::vector<ValueRule> plausibility_rules(const study::StudyPlan& plan);

/// A rule that warns once, at the first of these parameters that the manifest gives.
ValueRule plausible(std::vector<parameter::Handle> parameters,
                    std::function<std::vector<ValueFault>(const Ranges& of)> find_faults);

/// The parameter with the resolution of the fine encoder.
parameter::Handle fine_encoder(const study::StudyPlan& plan);

/// Resolution Δx of the fine encoder, rad or m.
/// @param encoder typical value of the parameter fine_encoder()
double typical_count(const study::StudyPlan& plan, double encoder);

/// Keys that have an effect only under a condition. A given key is reported if the condition holds at no
/// design point.
struct EffectRule {
  std::vector<std::string_view>
      keys{};  ///< dotted paths of parameters, or of sections (all their parameters)
  std::vector<std::string_view> except{};       ///< parameters among `keys` to which the rule does not apply
  std::vector<parameter::Handle> depends_on{};  ///< parameters that decide whether the keys have an effect
  /// Whether the keys have an effect, from the ranges of the parameters `depends_on`.
  std::function<bool(const Ranges&)> has_effect{};
  std::string what{};       ///< first phrase of the message
  std::string expected{};   ///< second phrase of the message; empty for a warning
  bool off_at_zero{false};  ///< a key that is 0 at all points is not reported
  bool warn_only{false};
};

/// The rules for a plan of this kind. If several rules match a key, the first violated one is reported.
std::vector<EffectRule> effect_rules(const study::StudyPlan& plan);

/// Whether the rule applies to the parameter with this dotted path.
bool covers(const EffectRule& rule, std::string_view name);

/// Whether the keys of the rule have an effect at some design point. True if a value could not be read.
bool can_have_effect(const study::StudyPlan& plan, const EffectRule& rule);

/// Whether the parameter with this dotted path has an effect at some design point according to all given
/// rules.
bool has_effect(const study::StudyPlan& plan, std::span<const EffectRule> rules, std::string_view name);

}  // namespace zerocount::rules
