#include "experiments/rules/effect_rules.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/friction/law.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/parameters/phase_path.hpp"

namespace zerocount::rules {
namespace {

using Limits = std::span<const study::ValueLimits>;
using parameters::joined;
using parameters::Literal;
using parameters::Phase;
using parameters::phase_path;

bool always(Limits) {
  return true;
}
bool never(Limits) {
  return false;
}

template <auto word>
bool is_word(const study::ValueLimits& limits) {
  return limits.low == static_cast<double>(word);
}

friction::FrictionModel friction_model(const study::ValueLimits& limits) {
  return static_cast<friction::FrictionModel>(static_cast<int>(limits.low));
}

bool can_be_positive(const study::ValueLimits& limits) {
  return limits.high > 0.0;
}

constexpr const char* the_loop_is_open = "it has no effect: the loop is open with command.torque";
constexpr const char* a_closed_loop = "command.targets or command.sequence, or the key left out";

std::vector<EffectRule> rules_of_the_command(const study::StudyPlan& plan) {
  const bool open_loop = plan.open_loop;
  return {
      {.keys = {"controller", "command.profile", "verdict"},
       .except = {"controller.sample_rate", "controller.delay", "controller.jitter", "controller.parameters"},
       .has_effect = open_loop ? never : always,
       .what = the_loop_is_open,
       .expected = a_closed_loop},
      {.keys = {"initial.integral"},
       .has_effect = open_loop ? never : always,
       .what = the_loop_is_open,
       .expected = a_closed_loop,
       .off_at_zero = true},
      {.keys = {"command.torque"},
       .has_effect = open_loop ? always : never,
       .what = "it has no effect without command.torque.levels",
       .expected = "command.torque with its levels, or the key left out"},
      {.keys = {"command.torque.rate"},
       .has_effect = plan.common.command.torque.record ? never : always,
       .what = "it has no effect: command.torque.file defines the torque",
       .expected = "levels with their rate, or the key left out"},
      {.keys = {"command.sequence"},
       .has_effect = plan.sequence ? always : never,
       .what = "it has no effect without command.sequence",
       .expected = "command.sequence with its targets, or the key left out"},
      {.keys = {"dac"},
       .depends_on = {"command.torque.through"},
       .has_effect = [open_loop](Limits l) { return !open_loop || is_word<trial::TorquePath::dac>(l[0]); },
       .what = "it has no effect: command.torque.through is never dac",
       .expected = "command.torque.through: dac, or the key left out"},
      {.keys = {"command.profile.velocity_limit", "command.profile.acceleration_limit"},
       .depends_on = {"command.profile.shape"},
       .has_effect =
           [](Limits l) {
             return is_word<loop::ReferenceShape::trapezoidal>(l[0]) ||
                    is_word<loop::ReferenceShape::s_curve>(l[0]);
           },
       .what = "it has no effect: the reference goes from target to target in steps, or is a sine",
       .expected = "command.profile.shape: trapezoidal or s_curve, or the key left out"},
      {.keys = {"command.profile.amplitude", "command.profile.frequency"},
       .depends_on = {"command.profile.shape"},
       .has_effect = [](Limits l) { return is_word<loop::ReferenceShape::sine>(l[0]); },
       .what = "it has no effect: the reference is never a sine",
       .expected = "command.profile.shape: sine, or the key left out"},
      {.keys = {"verdict.rest_band"},
       .depends_on = {"verdict.motion"},
       .has_effect = [](Limits l) { return can_be_positive(l[0]); },
       .what = "it has no effect: the true motion is not measured",
       .expected = "verdict.motion: true, or the key left out"},
      {.keys = {"command.profile.jerk_limit"},
       .depends_on = {"command.profile.shape"},
       .has_effect = [](Limits l) { return is_word<loop::ReferenceShape::s_curve>(l[0]); },
       .what = "it has no effect: the reference is never an s_curve",
       .expected = "command.profile.shape: s_curve, or the key left out"},
  };
}

EffectRule rule_of_the_plugin(const study::StudyPlan& plan) {
  const bool plugin = plan.plugin != nullptr;
  return {.keys = {"controller.kp", "controller.ki", "controller.kd", "controller.anti_windup",
                   "controller.structure", "controller.cascade", "controller.deadband",
                   "controller.integrator_zone", "controller.integrator_leak", "controller.derivative_cutoff",
                   "controller.derivative_window", "controller.error_deadband", "controller.standstill"},
          .has_effect = plugin ? never : always,
          .what = "it has no effect: the controller is a plugin",
          .expected = "controller.parameters, or the key left out"};
}

// The other parameters of an encoder error have an effect only if its amplitude is not 0.
template <Literal encoder>
std::vector<EffectRule> rules_of_errors() {
  const auto rule = [](std::string_view key, std::string_view amplitude) {
    return EffectRule{.keys = {key},
                      .depends_on = {amplitude},
                      .has_effect = [](Limits l) { return can_be_positive(l[0]); },
                      .what = "it has no effect: that error is 0 at every point",
                      .expected = fmt::format("{} above 0, or the key left out", amplitude)};
  };
  return {rule(joined<encoder, ".eccentricity_angle">, joined<encoder, ".eccentricity">),
          rule(joined<encoder, ".interpolation_period">, joined<encoder, ".interpolation">),
          rule(joined<encoder, ".noise_bandwidth">, joined<encoder, ".noise">)};
}

// With an encoder on each mass there is no coarse one.
std::vector<EffectRule> rules_of_two_encoders() {
  const auto has_second = [](Limits l) { return can_be_positive(l[0]) || can_be_positive(l[1]); };
  const auto always_has_second = [](Limits l) { return l[0].low > 0.0 || l[1].low > 0.0; };
  return {{.keys = {"encoder.load.fine_errors", "initial.load_encoder_phase"},
           .depends_on = {"encoder.load.counts_per_revolution", "encoder.load.resolution"},
           .has_effect = has_second,
           .what = "it has no effect: no point has an encoder on the second mass",
           .expected = "encoder.load, or the key left out"},
          {.keys = {"encoder.coarse", "encoder.coarse_resolution", "encoder.coarse_errors"},
           .depends_on = {"encoder.load.counts_per_revolution", "encoder.load.resolution"},
           .has_effect = [always_has_second](Limits l) { return !always_has_second(l); },
           .what = "it has no effect: beside encoder.fine, which reads the motor, encoder.load reads the "
                   "load",
           .expected = "either a coarse encoder or encoder.load"}};
}

std::vector<EffectRule> rules_of_the_loop() {
  return {
      {.keys = {"controller.coarse"},
       .except = {"controller.coarse.coarse_beyond"},
       .depends_on = {"controller.coarse.coarse_beyond"},
       .has_effect = [](Limits l) { return study::can_have_coarse_phase(l[0]); },
       .what = "it has no effect: no point has a coarse phase",
       .expected = "controller.coarse.coarse_beyond below 1e12, or the key left out"},
      {.keys = {"controller.dither.frequency"},
       .depends_on = {"controller.dither.amplitude"},
       .has_effect = [](Limits l) { return can_be_positive(l[0]); },
       .what = "it has no effect: no point has a dither",
       .expected = "controller.dither.amplitude above 0, or the key left out"},
  };
}

// Rules of the blocks of one phase. If a gain may be 0 on purpose, as in a sweep, only warnings.
template <Phase phase>
std::vector<EffectRule> rules_of_the_blocks() {
  const auto is_cascade = [](const study::ValueLimits& structure) {
    return is_word<loop::ControlStructure::cascade>(structure);
  };
  const auto has_integral = [is_cascade](Limits l) {
    return can_be_positive(is_cascade(l[0]) ? l[2] : l[1]);
  };
  const auto is_given = [](Limits l) { return l[0].high >= 0.0; };
  return {
      {.keys = {phase_path<phase, "error_deadband.form">},
       .depends_on = {phase_path<phase, "error_deadband.band">},
       .has_effect = is_given,
       .what = "it has no effect: no point has a dead zone of the error",
       .expected = fmt::format("{} too, or the key left out", phase_path<phase, "error_deadband.band">)},
      {.keys = {phase_path<phase, "hold.leave">, phase_path<phase, "hold.dwell">},
       .depends_on = {phase_path<phase, "hold.enter">},
       .has_effect = is_given,
       .what = "it has no effect: the torque is never held",
       .expected = fmt::format("{} too, or the key left out", phase_path<phase, "hold.enter">)},
      {.keys = {phase_path<phase, "standstill.dwell">, phase_path<phase, "standstill.kp">,
                phase_path<phase, "standstill.ki">, phase_path<phase, "standstill.kd">},
       .depends_on = {phase_path<phase, "standstill.band">},
       .has_effect = is_given,
       .what = "it has no effect: no point has gains at standstill",
       .expected = fmt::format("{} too, or the key left out", phase_path<phase, "standstill.band">)},
      {.keys = {phase_path<phase, "standstill">},
       .depends_on = {phase_path<phase, "structure">},
       .has_effect = [is_cascade](Limits l) { return !is_cascade(l[0]); },
       .what = "it has no effect: the control is a cascade at every point",
       .expected = fmt::format("{}: pid, or the key left out", phase_path<phase, "structure">)},
      {.keys = {phase_path<phase, "kp">, phase_path<phase, "ki">, phase_path<phase, "kd">},
       .depends_on = {phase_path<phase, "structure">},
       .has_effect = [is_cascade](Limits l) { return !is_cascade(l[0]); },
       .what = "it has no effect: the control is a cascade at every point",
       .expected = fmt::format("{}: pid, or the key left out", phase_path<phase, "structure">)},
      {.keys = {phase_path<phase, "cascade">},
       .depends_on = {phase_path<phase, "structure">},
       .has_effect = [is_cascade](Limits l) { return is_cascade(l[0]); },
       .what = "it has no effect: the control is never a cascade",
       .expected = fmt::format("{}: cascade, or the key left out", phase_path<phase, "structure">)},
      {.keys = {phase_path<phase, "deadband.leave">},
       .depends_on = {phase_path<phase, "deadband.enter">},
       .has_effect = [](Limits l) { return l[0].high >= 0.0; },
       .what = "it has no effect: no point has a deadband",
       .expected = fmt::format("{} too, or the key left out", phase_path<phase, "deadband.enter">)},
      {.keys = {phase_path<phase, "observer.inertia">},
       .depends_on = {phase_path<phase, "observer.bandwidth">},
       .has_effect = [](Limits l) { return can_be_positive(l[0]); },
       .what = "it has no effect: no point has a disturbance observer",
       .expected = fmt::format("{} above 0, or the key left out", phase_path<phase, "observer.bandwidth">)},
      {.keys = {phase_path<phase, "feedforward">},
       .depends_on = {"command.profile.shape"},
       .has_effect = [](Limits l) { return !is_word<loop::ReferenceShape::step>(l[0]); },
       .what = "it has no effect: the reference is a step at every point",
       .expected = "command.profile.shape: trapezoidal, s_curve or sine, or the key left out",
       .off_at_zero = true},
      {.keys = {phase_path<phase, "deadband">, phase_path<phase, "integrator_zone">},
       .depends_on = {phase_path<phase, "structure">, phase_path<phase, "ki">,
                      phase_path<phase, "cascade.ki">},
       .has_effect = has_integral,
       .what = "it has no effect: no point has integral control",
       .off_at_zero = true,
       .warn_only = true},
      {.keys = {phase_path<phase, "derivative_cutoff">},
       .depends_on = {phase_path<phase, "structure">, phase_path<phase, "kd">},
       .has_effect = [is_cascade](Limits l) { return is_cascade(l[0]) || can_be_positive(l[1]); },
       .what = "it has no effect: the control never uses the difference of counts",
       .off_at_zero = true,
       .warn_only = true},
  };
}

std::vector<EffectRule> rules_of_the_drive() {
  return {
      {.keys = {"controller.cascade.feedforward"},
       .depends_on = {"command.profile.shape"},
       .has_effect = [](Limits l) { return !is_word<loop::ReferenceShape::step>(l[0]); },
       .what = "it has no effect: the reference is a step at every point",
       .expected = "command.profile.shape: trapezoidal, s_curve or sine, or the key left out",
       .off_at_zero = true},
      {.keys = {"controller.derivative_window"},
       .depends_on = {"controller.structure", "controller.kd", "controller.standstill.kd"},
       .has_effect =
           [](Limits l) {
             return is_word<loop::ControlStructure::cascade>(l[0]) || can_be_positive(l[1]) ||
                    can_be_positive(l[2]);
           },
       .what = "it has no effect: the control never uses the difference of counts",
       .warn_only = true},
  };
}

EffectRule rule_of_the_resolution() {
  return {.keys = {"dac.resolution"},
          .depends_on = {"dac.range"},
          .has_effect = [](Limits l) { return !can_be_positive(l[0]); },
          .what = "it has no effect: dac.range gives the resolution at every point",
          .expected = "either dac.resolution or dac.range"};
}

EffectRule rule_of_the_load() {
  return {
      .keys = {"plant.load.stiffness", "plant.load.damping", "plant.load.encoder", "plant.load.gap",
               "plant.load.damping_to_ground", "plant.load.error", "plant.load.friction", "disturbance.load",
               "encoder.load", "controller.cascade.position", "controller.cascade.velocity"},
      .depends_on = {"plant.load.inertia"},
      .has_effect = [](Limits l) { return can_be_positive(l[0]); },
      .what = "it has no effect: no point has a second mass",
      .expected = "plant.load.inertia above 0, or the key left out"};
}

// The friction of the load: its model decides which parameters act.
std::vector<EffectRule> rules_of_the_load_friction() {
  using Model = friction::LoadFrictionModel;
  const auto rule = [](std::vector<std::string_view> keys, bool (*has_effect)(Limits)) {
    return EffectRule{
        .keys = std::move(keys),
        .depends_on = {"plant.load.friction.model"},
        .has_effect = has_effect,
        .what = "it has no effect: plant.load.friction.model has no such parameter at any point",
        .expected = "another plant.load.friction.model, or the key left out"};
  };
  return {rule({"plant.load.friction.breakaway", "plant.load.friction.coulomb_ratio"},
               [](Limits l) { return !is_word<Model::none>(l[0]); }),
          rule({"plant.load.friction.stribeck_velocity"},
               [](Limits l) { return is_word<Model::coulomb>(l[0]) || is_word<Model::lugre>(l[0]); }),
          rule({"plant.load.friction.sigma0"},
               [](Limits l) { return is_word<Model::dahl>(l[0]) || is_word<Model::lugre>(l[0]); }),
          rule({"plant.load.friction.sigma1"}, [](Limits l) { return is_word<Model::lugre>(l[0]); })};
}

EffectRule rule_of_the_initial_gap() {
  return {.keys = {"initial.gap"},
          .depends_on = {"plant.load.inertia", "plant.load.gap"},
          .has_effect = [](Limits l) { return can_be_positive(l[0]) && can_be_positive(l[1]); },
          .what = "it has no effect: no point has a second mass behind a gap",
          .expected = "plant.load.gap above 0, or the key left out"};
}

// Only a warning, so that a study can be switched between both cases with one key.
EffectRule rule_of_the_limit() {
  return {.keys = {"verdict.limit"},
          .depends_on = {"verdict.stop"},
          .has_effect = [](Limits l) { return l[0].high > 0.0; },
          .what = "it has no effect: verdict.stop is never true",
          .warn_only = true};
}

std::vector<EffectRule> rules_of_the_contact() {
  const auto both_positive = [](Limits l) { return can_be_positive(l[0]) && can_be_positive(l[1]); };
  return {
      {.keys = {"initial.hardening", "initial.preload", "initial.history"},
       .depends_on = {"initial.mode"},
       .has_effect = [](Limits l) { return is_word<trial::InitialMode::stick>(l[0]); },
       .what = "it has no effect: the hook slides at the start, at every point",
       .expected = "initial.mode: stick, or the key left out",
       .off_at_zero = true},
      {.keys = {"initial.history.torque"},
       .depends_on = {"initial.history.reversals", "initial.history.torque"},
       .has_effect = both_positive,
       .what = "it has no effect: initial.history.reversals is 0 at every point",
       .expected = "initial.history.reversals at least 1, or the key left out",
       .off_at_zero = true},
      {.keys = {"initial.history.reversals"},
       .depends_on = {"initial.history.reversals", "initial.history.torque"},
       .has_effect = both_positive,
       .what = "it has no effect: initial.history.torque is 0 at every point",
       .expected = "initial.history.torque above 0, or the key left out",
       .off_at_zero = true},
  };
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
          .depends_on = {"friction.model"},
          .has_effect = [property](Limits l) { return property(friction::traits_of(friction_model(l[0]))); },
          .what = fmt::format("it has no effect: friction.model is never one that uses it ({})",
                              models_with(property)),
          .off_at_zero = true,
          .warn_only = true};
}

/// An error, because no other key says what these models have instead.
EffectRule of_measured_spring() {
  EffectRule rule =
      with_models([](const friction::LawTraits& law) { return uses(law, &friction::FrictionParameters::k1); },
                  {"friction.measured"});
  rule.except = {"friction.measured.creep"};
  rule.expected = "friction.model: presliding or spring, or the constants of the model";
  rule.warn_only = false;
  return rule;
}

std::vector<EffectRule> rules_of_the_model() {
  using friction::LawTraits;
  std::vector<EffectRule> rules{
      with_models([](const LawTraits& law) { return law.has_sliding_damping; }, {"plant.sliding_damping"}),
      with_models([](const LawTraits& law) { return law.has_presliding_damping; },
                  {"plant.presliding_damping"}),
      with_models([](const LawTraits& law) { return law.remembers_loading; },
                  {"initial.preload", "initial.history"}),
      with_models([](const LawTraits& law) { return uses(law, &friction::FrictionParameters::alpha); },
                  {"initial.hardening", "friction.measured.creep"}),
      of_measured_spring(),
      with_models(
          [](const LawTraits& law) { return uses(law, &friction::FrictionParameters::gms_attraction); },
          {"friction.gms.stiffness", "friction.gms.weight"}),
      with_models([](const LawTraits& law) { return law.has_presliding_motion; }, {"initial.mode"})};
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    const friction::ContactField field = parameter.profiled;
    if (field == nullptr) continue;
    rules.push_back(
        with_models([field](const LawTraits& law) { return uses(law, field); }, {parameter.name}));
  }
  return rules;
}

// Only warnings: another value may switch off a term of friction.
std::vector<EffectRule> rules_of_vanished_terms() {
  return {
      {.keys = {"friction.lambda", "friction.n", "friction.measured.creep.torque",
                "friction.measured.creep.extension", "friction.measured.creep.exponent", "initial.hardening"},
       .depends_on = {"friction.model", "friction.alpha"},
       .has_effect =
           [](Limits l) { return friction::has_creep(friction_model(l[0])) && can_be_positive(l[1]); },
       .what = "it has no effect: the rate of creep is 0 wherever friction.model is presliding",
       .off_at_zero = true,
       .warn_only = true},
      {.keys = {"friction.beta"},
       .depends_on = {"friction.model", "friction.k2"},
       .has_effect =
           [](Limits l) { return friction::has_spring(friction_model(l[0])) && can_be_positive(l[1]); },
       .what = "it has no effect: friction.k2 is 0 wherever friction.model has a spring",
       .warn_only = true},
      {.keys = {"friction.stribeck_velocity"},
       .depends_on = {"friction.coulomb_ratio"},
       .has_effect = [](Limits l) { return l[0].low < 1.0; },
       .what = "it has no effect: friction.coulomb_ratio is 1 at every point",
       .warn_only = true},
  };
}

bool has_ripple(const study::StudyPlan& plan) {
  return std::any_of(plan.table.rows.begin(), plan.table.rows.end(), [](const auto& row) {
    return parameters::has_value(row) &&
           (row.name.starts_with("disturbance.ripple.") || row.name.starts_with("disturbance.load.ripple.") ||
            row.name.starts_with("plant.load.error."));
  });
}

EffectRule rule_of_holding(const study::StudyPlan& plan) {
  const bool tilts = std::ranges::any_of(plan.table.rows, [](const auto& row) {
    return parameters::has_value(row) && row.name.starts_with("disturbance.load.ripple.");
  });
  return {.keys = {"initial.holding"},
          .depends_on = {"disturbance.torque", "disturbance.load.torque"},
          .has_effect =
              [tilts](Limits l) {
                return tilts || std::ranges::any_of(l, [](const auto& torque) {
                         return torque.low != 0.0 || torque.high != 0.0;
                       });
              },
          .what = "it has no effect: nothing constant acts on the axis at any point",
          .warn_only = true};
}

// The position on the rotor selects from friction profiles and from encoder errors fixed to the rotor.
EffectRule rule_of_the_position(const study::StudyPlan& plan) {
  const bool has_profile = !plan.profiles.empty() || has_ripple(plan);
  return {
      .keys = {"initial.position"},
      .depends_on = {"encoder.fine_errors.eccentricity", "encoder.fine_errors.interpolation",
                     "encoder.coarse_errors.eccentricity", "encoder.coarse_errors.interpolation",
                     "encoder.load.fine_errors.eccentricity", "encoder.load.fine_errors.interpolation"},
      .has_effect =
          [has_profile](Limits l) { return has_profile || std::any_of(l.begin(), l.end(), can_be_positive); },
      .what =
          "it has no effect: nothing varies along the $track, neither a friction profile, a ripple nor an "
          "eccentricity or interpolation error of an encoder",
      .off_at_zero = true,
      .warn_only = true};
}

}  // namespace

std::vector<EffectRule> effect_rules(const study::StudyPlan& plan) {
  std::vector<EffectRule> rules = rules_of_the_command(plan);
  rules.push_back(rule_of_the_position(plan));
  rules.push_back(rule_of_holding(plan));
  rules.push_back(rule_of_the_limit());
  rules.push_back(rule_of_the_load());
  rules.push_back(rule_of_the_initial_gap());
  rules.push_back(rule_of_the_resolution());
  rules.push_back(rule_of_the_plugin(plan));
  for (const auto& more :
       {rules_of_errors<"encoder.fine_errors">(), rules_of_errors<"encoder.coarse_errors">(),
        rules_of_errors<"encoder.load.fine_errors">(), rules_of_two_encoders(), rules_of_the_loop(),
        rules_of_the_load_friction(), rules_of_the_drive(), rules_of_the_blocks<Phase::fine>(),
        rules_of_the_blocks<Phase::coarse>(), rules_of_the_contact(), rules_of_the_model(),
        rules_of_vanished_terms()}) {
    rules.insert(rules.end(), more.begin(), more.end());
  }
  return rules;
}

bool covers(const EffectRule& rule, std::string_view name) {
  const auto is_named_by = [name](std::string_view key) {
    return name.starts_with(key) && (name.size() == key.size() || name[key.size()] == '.');
  };
  return std::ranges::any_of(rule.keys, is_named_by) && std::ranges::none_of(rule.except, is_named_by);
}

bool can_have_effect(const study::StudyPlan& plan, const EffectRule& rule) {
  return study::holds_somewhere(plan, rule.depends_on, [&](std::span<const study::ValueLimits> limits) {
    return !study::are_readable(limits) || rule.has_effect(limits);
  });
}

bool has_effect(const study::StudyPlan& plan, std::span<const EffectRule> rules, std::string_view name) {
  return std::ranges::all_of(
      rules, [&](const EffectRule& rule) { return !covers(rule, name) || can_have_effect(plan, rule); });
}

}  // namespace zerocount::rules
