#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/friction/law.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/parameters/phase_path.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/effects.hpp"

namespace zerocount::rules {
namespace {

using Keys = std::vector<std::string_view>;
using parameters::Phase;
using parameters::phase_path;
using study::ParameterRange;

constexpr std::string_view or_left_out = ", or the key left out";

template <class Word>
bool is_word(const ParameterRange& range, Word word) {
  return range.low == static_cast<double>(word);
}

friction::FrictionModel friction_model(const ParameterRange& range) {
  return static_cast<friction::FrictionModel>(static_cast<int>(range.low));
}

bool can_be_positive(const ParameterRange& range) {
  return range.high > 0.0;
}

/// One parameter of the manifest that decides whether other keys have an effect.
struct Switch {
  parameter::Handle parameter;
  std::function<bool(const ParameterRange&)> is_on;
  std::string on;  ///< text for messages that says how a manifest turns the switch on: "… above 0"
};

Switch above_zero(parameter::Handle parameter) {
  return {parameter, can_be_positive, fmt::format("{} above 0", parameter.path)};
}

/// A switch that is on if the manifest gives the parameter. The default of the parameter must be negative.
Switch given(parameter::Handle parameter) {
  return {parameter, [](const ParameterRange& range) { return range.high >= 0.0; },
          fmt::format("{} too", parameter.path)};
}

/// A switch for a parameter whose values are labels: it is on if the value is one of these labels.
template <class Word>
Switch one_of(parameter::Handle parameter, std::initializer_list<Word> words) {
  const auto& labels = parameters::parameter_table()[parameters::find_parameter(parameter).value()].labels;
  Keys named;
  for (const Word word : words) named.push_back(labels[static_cast<std::size_t>(word)]);
  const std::string_view last = named.back();
  named.pop_back();
  return {
      parameter,
      [all = std::vector<Word>(words)](const ParameterRange& range) {
        return std::ranges::any_of(all, [&](Word word) { return is_word(range, word); });
      },
      fmt::format("{}: {}{}{}", parameter.path, fmt::join(named, ", "), named.empty() ? "" : " or ", last)};
}

std::string no_effect(std::string_view reason) {
  return fmt::format("it has no effect: {}", reason);
}

/// The rule for keys that have an effect only if the switch `by` is on.
/// @param off phrase for the message if the switch is off at every point
EffectRule only_with(const Switch& by, Keys keys, std::string_view off) {
  return {.keys = std::move(keys),
          .depends_on = {by.parameter},
          .has_effect = [by](const Ranges& of) { return by.is_on(of[by.parameter]); },
          .what = no_effect(off),
          .expected = fmt::format("{}{}", by.on, or_left_out)};
}

/// The rule for keys that have no effect at all in this kind of study.
/// @param what phrase that says why
/// @param instead the key that would have the effect, for the message
EffectRule idle(Keys keys, std::string what, std::string_view instead) {
  return {.keys = std::move(keys),
          .has_effect = [](const Ranges&) { return false; },
          .what = std::move(what),
          .expected = fmt::format("{}{}", instead, or_left_out)};
}

EffectRule except(Keys keys, EffectRule rule) {
  rule.except = std::move(keys);
  return rule;
}

/// The same rule, but a key that is 0 at all design points is not reported.
EffectRule unless_zero(EffectRule rule) {
  rule.off_at_zero = true;
  return rule;
}

/// The same rule as a warning instead of an error, for a key that a study may keep on purpose while another
/// key switches between cases.
EffectRule warning(EffectRule rule) {
  rule.warn_only = true;
  rule.expected.clear();
  return rule;
}

std::vector<EffectRule> rules_of_the_kind(const study::StudyPlan& plan) {
  std::vector<EffectRule> rules;
  if (plan.open_loop) {
    constexpr const char* open = "the loop is open with command.torque";
    constexpr const char* closed = "command.targets, reference or sequence";
    rules.push_back(except({parameter::controller::sample_rate, parameter::controller::delay,
                            parameter::controller::jitter, "controller.parameters"},
                           idle({"controller", "command.profile", "verdict"}, no_effect(open), closed)));
    rules.push_back(unless_zero(idle({parameter::initial::integral}, no_effect(open), closed)));
    rules.push_back(only_with(one_of(parameter::command::torque::through, {trial::TorquePath::dac}), {"dac"},
                              "command.torque.through is never dac"));
  } else {
    rules.push_back(idle({"command.torque"}, "it has no effect without command.torque.levels",
                         "command.torque with its levels"));
  }
  if (plan.common.command.torque.record)
    rules.push_back(idle({parameter::command::torque::rate},
                         no_effect("command.torque.file defines the torque"), "levels with their rate"));
  if (!plan.sequence)
    rules.push_back(idle({"command.sequence"}, "it has no effect without command.sequence",
                         "command.sequence with its targets"));
  return rules;
}

EffectRule rule_of_the_plugin() {
  return idle(
      {parameter::controller::kp, parameter::controller::ki, parameter::controller::kd,
       parameter::controller::anti_windup, parameter::controller::structure, "controller.cascade",
       "controller.deadband", parameter::controller::integrator_zone, parameter::controller::integrator_leak,
       parameter::controller::derivative_cutoff, parameter::controller::derivative_window,
       "controller.error_deadband", "controller.standstill"},
      no_effect("the controller is a plugin"), "controller.parameters");
}

std::vector<EffectRule> rules_of_the_reference() {
  using Shape = loop::ReferenceShape;
  constexpr parameter::Handle shape = parameter::command::profile::shape;
  return {only_with(
              one_of(shape, {Shape::trapezoidal, Shape::s_curve}),
              {parameter::command::profile::velocity_limit, parameter::command::profile::acceleration_limit},
              "the reference goes from target to target in steps, or is a sine"),
          only_with(one_of(shape, {Shape::sine}),
                    {parameter::command::profile::amplitude, parameter::command::profile::frequency},
                    "the reference is never a sine"),
          only_with(one_of(parameter::verdict::motion, {true}), {parameter::verdict::rest_band},
                    "the true motion is not measured"),
          only_with(one_of(shape, {Shape::s_curve}), {parameter::command::profile::jerk_limit},
                    "the reference is never an s_curve")};
}

/// The rule for keys that have an effect only if the reference moves, so that it is not a step.
EffectRule with_a_moving_reference(Keys keys) {
  using Shape = loop::ReferenceShape;
  return unless_zero(only_with(one_of(parameter::command::profile::shape,
                                      {Shape::trapezoidal, Shape::s_curve, Shape::sine, Shape::record}),
                               std::move(keys), "the reference is a step at every point"));
}

// The other parameters of an effect act only with it.
std::vector<EffectRule> rules_of_shapes() {
  std::vector<EffectRule> rules;
  for (const study::Effect& effect : study::effects())
    if (!effect.shape.empty())
      rules.push_back(only_with(above_zero(parameter::Handle(effect.parameter)), {effect.shape},
                                "that error is 0 at every point"));
  return rules;
}

// With an encoder on each mass there is no coarse one.
std::vector<EffectRule> rules_of_two_encoders() {
  const std::vector<parameter::Handle> second{parameter::encoder::load::counts_per_revolution,
                                              parameter::encoder::load::resolution};
  return {
      {.keys = {"encoder.load.fine_errors", parameter::initial::load_encoder_phase},
       .depends_on = second,
       .has_effect = [](const Ranges& of) { return std::ranges::any_of(of.all(), can_be_positive); },
       .what = no_effect("no point has an encoder on the second mass"),
       .expected = fmt::format("encoder.load{}", or_left_out)},
      {.keys = {parameter::encoder::coarse, parameter::encoder::coarse_resolution, "encoder.coarse_errors"},
       .depends_on = second,
       .has_effect =
           [](const Ranges& of) {
             return std::ranges::none_of(of.all(),
                                         [](const ParameterRange& range) { return range.low > 0.0; });
           },
       .what = no_effect("beside encoder.fine, which reads the motor, encoder.load reads the load"),
       .expected = "either a coarse encoder or encoder.load"}};
}

std::vector<EffectRule> rules_of_the_loop() {
  constexpr parameter::Handle beyond = parameter::controller::coarse::coarse_beyond;
  const Switch coarse{beyond, study::can_have_coarse_phase, fmt::format("{} below 1e12", beyond.path)};
  return {except({beyond}, only_with(coarse, {"controller.coarse"}, "no point has a coarse phase")),
          only_with(above_zero(parameter::controller::dither::amplitude),
                    {parameter::controller::dither::frequency}, "no point has a dither")};
}

// Rules of the blocks of one phase. If a gain may be 0 on purpose, as in a sweep, only warnings.
template <Phase phase>
std::vector<EffectRule> rules_of_the_blocks() {
  using Structure = loop::ControlStructure;
  using Control = parameter::Control<phase>;
  constexpr parameter::Handle structure = Control::structure;
  const auto is_cascade = [](const Ranges& of) {
    return is_word(of[Control::structure], Structure::cascade);
  };
  return {
      only_with(given(Control::error_deadband::band), {Control::error_deadband::form},
                "no point has a dead zone of the error"),
      only_with(given(Control::hold::enter), {Control::hold::leave, Control::hold::dwell},
                "the torque is never held"),
      only_with(given(Control::standstill::band),
                {Control::standstill::dwell, Control::standstill::kp, Control::standstill::ki,
                 Control::standstill::kd},
                "no point has gains at standstill"),
      only_with(one_of(structure, {Structure::pid}),
                {phase_path<phase, "standstill">, Control::kp, Control::ki, Control::kd},
                "the control is a cascade at every point"),
      only_with(one_of(structure, {Structure::cascade}), {phase_path<phase, "cascade">},
                "the control is never a cascade"),
      only_with(given(Control::deadband::enter), {Control::deadband::leave}, "no point has a deadband"),
      only_with(above_zero(Control::observer::bandwidth), {Control::observer::inertia},
                "no point has a disturbance observer"),
      with_a_moving_reference({phase_path<phase, "feedforward">}),
      {.keys = {phase_path<phase, "deadband">, Control::integrator_zone},
       .depends_on = {structure, Control::ki, Control::cascade::ki},
       .has_effect =
           [is_cascade](const Ranges& of) {
             return can_be_positive(is_cascade(of) ? of[Control::cascade::ki] : of[Control::ki]);
           },
       .what = no_effect("no point has integral control"),
       .off_at_zero = true,
       .warn_only = true},
      {.keys = {Control::derivative_cutoff},
       .depends_on = {structure, Control::kd},
       .has_effect =
           [is_cascade](const Ranges& of) { return is_cascade(of) || can_be_positive(of[Control::kd]); },
       .what = no_effect("the control never uses the difference of counts"),
       .off_at_zero = true,
       .warn_only = true},
  };
}

std::vector<EffectRule> rules_of_the_drive() {
  return {with_a_moving_reference({parameter::controller::cascade::feedforward}),
          {.keys = {parameter::controller::derivative_window},
           .depends_on = {parameter::controller::structure, parameter::controller::kd,
                          parameter::controller::standstill::kd},
           .has_effect =
               [](const Ranges& of) {
                 return is_word(of[parameter::controller::structure], loop::ControlStructure::cascade) ||
                        can_be_positive(of[parameter::controller::kd]) ||
                        can_be_positive(of[parameter::controller::standstill::kd]);
               },
           .what = no_effect("the control never uses the difference of counts"),
           .warn_only = true}};
}

EffectRule rule_of_the_resolution() {
  return {.keys = {parameter::dac::resolution},
          .depends_on = {parameter::dac::range},
          .has_effect = [](const Ranges& of) { return !can_be_positive(of[parameter::dac::range]); },
          .what = no_effect("dac.range gives the resolution at every point"),
          .expected = "either dac.resolution or dac.range"};
}

std::vector<EffectRule> rules_of_the_load() {
  return {
      except({parameter::plant::load::inertia},
             only_with(above_zero(parameter::plant::load::inertia),
                       {"plant.load", "disturbance.load", "encoder.load",
                        parameter::controller::cascade::position, parameter::controller::cascade::velocity},
                       "no point has a second mass")),
      {.keys = {parameter::initial::gap},
       .depends_on = {parameter::plant::load::inertia, parameter::plant::load::gap},
       .has_effect = [](const Ranges& of) { return std::ranges::all_of(of.all(), can_be_positive); },
       .what = no_effect("no point has a second mass behind a gap"),
       .expected = fmt::format("plant.load.gap above 0{}", or_left_out)}};
}

// The friction of the load: its model decides which parameters act.
std::vector<EffectRule> rules_of_the_load_friction() {
  using Model = friction::LoadFrictionModel;
  const auto rule = [](std::initializer_list<Model> models, Keys keys) {
    Switch model = one_of(parameter::plant::load::friction::model, models);
    model.on = "another plant.load.friction.model";
    return only_with(model, std::move(keys), "plant.load.friction.model has no such parameter at any point");
  };
  return {
      rule({Model::coulomb, Model::dahl, Model::lugre},
           {parameter::plant::load::friction::breakaway, parameter::plant::load::friction::coulomb_ratio}),
      rule({Model::coulomb, Model::lugre}, {parameter::plant::load::friction::stribeck_velocity}),
      rule({Model::dahl, Model::lugre}, {parameter::plant::load::friction::sigma0}),
      rule({Model::lugre}, {parameter::plant::load::friction::sigma1})};
}

std::vector<EffectRule> rules_of_the_contact() {
  constexpr parameter::Handle reversals = parameter::initial::history::reversals;
  constexpr parameter::Handle torque = parameter::initial::history::torque;
  const auto rule = [&](parameter::Handle key, parameter::Handle other, std::string_view on) {
    return unless_zero(
        {.keys = {key},
         .depends_on = {reversals, torque},
         .has_effect = [](const Ranges& of) { return std::ranges::all_of(of.all(), can_be_positive); },
         .what = no_effect(fmt::format("{} is 0 at every point", other.path)),
         .expected = fmt::format("{} {}{}", other.path, on, or_left_out)});
  };
  return {
      unless_zero(only_with(one_of(parameter::initial::mode, {trial::InitialMode::stick}),
                            {parameter::initial::hardening, parameter::initial::preload, "initial.history"},
                            "the hook slides at the start, at every point")),
      rule(torque, reversals, "at least 1"), rule(reversals, torque, "above 0")};
}

// The models whose law has the property, for messages.
std::string models_with(const std::function<bool(const friction::LawTraits&)>& property) {
  std::vector<std::string_view> words;
  for (const friction::LawTraits& law : friction::all_traits()) {
    if (property(law)) words.push_back(law.word);
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

// Only a warning, so that models can be compared by changing one key.
EffectRule with_models(const std::function<bool(const friction::LawTraits&)>& property,
                       std::vector<std::string_view> keys) {
  return {.keys = std::move(keys),
          .depends_on = {parameter::friction::model},
          .has_effect =
              [property](const Ranges& of) {
                return property(friction::traits_of(friction_model(of[parameter::friction::model])));
              },
          .what = fmt::format("it has no effect: friction.model is never one that uses it ({})",
                              models_with(property)),
          .off_at_zero = true,
          .warn_only = true};
}

std::vector<EffectRule> rules_of_the_model() {
  using friction::LawTraits;
  using P = friction::FrictionParameters;
  const auto has = [](friction::ContactField field) {
    return [field](const LawTraits& law) { return uses(law, field); };
  };
  // An error, because no other key says what the other models have instead.
  EffectRule measured = except({"friction.measured.creep"}, with_models(has(&P::k1), {"friction.measured"}));
  measured.expected = "friction.model: presliding or spring, or the constants of the model";
  measured.warn_only = false;
  std::vector<EffectRule> rules{
      with_models([](const LawTraits& law) { return law.has_sliding_damping; },
                  {parameter::plant::sliding_damping}),
      with_models([](const LawTraits& law) { return law.has_presliding_damping; },
                  {parameter::plant::presliding_damping}),
      with_models([](const LawTraits& law) { return law.remembers_loading; },
                  {parameter::initial::preload, "initial.history"}),
      with_models(has(&P::alpha), {parameter::initial::hardening, "friction.measured.creep"}),
      measured,
      with_models(has(&P::gms_attraction),
                  {parameter::friction::gms::stiffness, parameter::friction::gms::weight}),
      with_models([](const LawTraits& law) { return law.has_presliding_motion; },
                  {parameter::initial::mode})};
  for (const parameters::Parameter& parameter : parameters::parameter_table())
    if (parameter.profiled != nullptr)
      rules.push_back(with_models(has(parameter.profiled), {parameter.name}));
  return rules;
}

// Only warnings: another value may switch off a term of friction.
std::vector<EffectRule> rules_of_vanished_terms() {
  return {
      {.keys = {parameter::friction::lambda, parameter::friction::n,
                parameter::friction::measured::creep::torque, parameter::friction::measured::creep::extension,
                parameter::friction::measured::creep::exponent, parameter::initial::hardening},
       .depends_on = {parameter::friction::model, parameter::friction::alpha},
       .has_effect =
           [](const Ranges& of) {
             return friction::has_creep(friction_model(of[parameter::friction::model])) &&
                    can_be_positive(of[parameter::friction::alpha]);
           },
       .what = no_effect("the rate of creep is 0 wherever friction.model is presliding"),
       .off_at_zero = true,
       .warn_only = true},
      {.keys = {parameter::friction::beta},
       .depends_on = {parameter::friction::model, parameter::friction::k2},
       .has_effect =
           [](const Ranges& of) {
             return friction::has_spring(friction_model(of[parameter::friction::model])) &&
                    can_be_positive(of[parameter::friction::k2]);
           },
       .what = no_effect("friction.k2 is 0 wherever friction.model has a spring"),
       .warn_only = true},
      {.keys = {parameter::friction::stribeck_velocity},
       .depends_on = {parameter::friction::coulomb_ratio},
       .has_effect = [](const Ranges& of) { return of[parameter::friction::coulomb_ratio].low < 1.0; },
       .what = no_effect("friction.coulomb_ratio is 1 at every point"),
       .warn_only = true},
  };
}

bool has_element(const study::StudyPlan& plan, std::initializer_list<std::string_view> lists) {
  return std::ranges::any_of(plan.table.rows, [&](const parameters::Parameter& row) {
    return parameters::has_value(row) &&
           std::ranges::any_of(lists, [&](std::string_view list) { return row.name.starts_with(list); });
  });
}

EffectRule rule_of_holding(const study::StudyPlan& plan) {
  return {.keys = {parameter::initial::holding},
          .depends_on = {parameter::disturbance::torque, parameter::disturbance::load::torque},
          .has_effect =
              [tilts = has_element(plan, {"disturbance.load.ripple."})](const Ranges& of) {
                return tilts || std::ranges::any_of(of.all(), study::can_be_nonzero);
              },
          .what = no_effect("nothing constant acts on the axis at any point"),
          .warn_only = true};
}

// The position on the rotor selects from friction profiles and from encoder errors fixed to the rotor.
EffectRule rule_of_the_position(const study::StudyPlan& plan) {
  const bool varies =
      !plan.profiles.empty() ||
      has_element(plan, {"disturbance.ripple.", "disturbance.load.ripple.", "plant.load.error."});
  EffectRule rule{
      .keys = {parameter::initial::position},
      .has_effect =
          [varies](const Ranges& of) { return varies || std::ranges::any_of(of.all(), can_be_positive); },
      .what = no_effect("nothing varies along the $track, neither a friction profile, a ripple nor an "
                        "eccentricity or interpolation error of an encoder"),
      .off_at_zero = true,
      .warn_only = true};
  for (const study::Effect& effect : study::effects())
    if (effect.along_track) rule.depends_on.emplace_back(effect.parameter);
  return rule;
}

}  // namespace

std::vector<EffectRule> effect_rules(const study::StudyPlan& plan) {
  std::vector<EffectRule> rules = rules_of_the_kind(plan);
  const auto add = [&rules](std::vector<EffectRule> more) {
    std::ranges::move(more, std::back_inserter(rules));
  };
  add(rules_of_the_reference());
  add({rule_of_the_position(plan), rule_of_holding(plan),
       warning(only_with(above_zero(parameter::verdict::stop), {parameter::verdict::limit},
                         "verdict.stop is never true"))});
  add(rules_of_the_load());
  add({rule_of_the_resolution()});
  if (plan.plugin != nullptr) add({rule_of_the_plugin()});
  add(rules_of_shapes());
  add(rules_of_two_encoders());
  add(rules_of_the_loop());
  add(rules_of_the_load_friction());
  add(rules_of_the_drive());
  add(rules_of_the_blocks<Phase::fine>());
  add(rules_of_the_blocks<Phase::coarse>());
  add(rules_of_the_contact());
  add(rules_of_the_model());
  add(rules_of_vanished_terms());
  return rules;
}

bool covers(const EffectRule& rule, std::string_view name) {
  const auto is_named_by = [name](std::string_view key) {
    return name.starts_with(key) && (name.size() == key.size() || name[key.size()] == '.');
  };
  return std::ranges::any_of(rule.keys, is_named_by) && std::ranges::none_of(rule.except, is_named_by);
}

bool can_have_effect(const study::StudyPlan& plan, const EffectRule& rule) {
  return study::holds_somewhere(plan, rule.depends_on, [&](const Ranges& of) {
    return !study::are_readable(of.all()) || rule.has_effect(of);
  });
}

bool has_effect(const study::StudyPlan& plan, std::span<const EffectRule> rules, std::string_view name) {
  return std::ranges::all_of(
      rules, [&](const EffectRule& rule) { return !covers(rule, name) || can_have_effect(plan, rule); });
}

}  // namespace zerocount::rules
