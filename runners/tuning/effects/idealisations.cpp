#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/friction/friction_model.hpp"
#include "core/friction/law.hpp"
#include "core/friction/profile.hpp"
#include "core/loop/controller/filter.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study_table.hpp"
#include "runners/tuning/effects/effects.hpp"

namespace zerocount::tuning {
namespace {

using study::PointEdit;
using study::ValueLimits;

constexpr const char* not_tuned_again = "same gains, not tuned again";

bool can_differ_from(double value, const ValueLimits& limits) {
  return limits.low != value || limits.high != value;
}

bool is_within(std::string_view name, std::string_view section) {
  return name.starts_with(section) && name.substr(section.size()).starts_with('.');
}

/// The encoders that close the loop, in any phase of any trial of the point.
struct LoopEncoders {
  bool fine{false};
  bool coarse{false};
};

LoopEncoders encoders_of(const PointEdit& at) {
  LoopEncoders encoders;
  const auto add = [&](std::string_view choice) {
    const ValueLimits limits = at.limits(choice);
    encoders.fine |= limits.low == static_cast<double>(loop::EncoderChoice::fine);
    encoders.coarse |= limits.high == static_cast<double>(loop::EncoderChoice::coarse);
  };
  add("controller.encoder");
  if (study::can_have_coarse_phase(at.limits("controller.coarse.coarse_beyond")))
    add("controller.coarse.encoder");
  return encoders;
}

/// Calls `visit(slot, row)` for each value of a trial.
template <class Visit>
void visit_values(const PointEdit& at, const Visit& visit) {
  const study::StudyTable& table = at.plan().table;
  for (const std::size_t slot : study::slots_in_table_order(table)) visit(slot, table.rows[slot]);
}

bool is_sampled_gain(const PointEdit& at, const parameters::Parameter& row) {
  return !row.si_unit.empty() && at.plan().units.gains == parameters::GainUnits::count;
}

// Ideal values.

/// Whether the parameter acts in trials of the point.
bool acts(const PointEdit& at, std::span<const rules::EffectRule> rules, std::string_view name) {
  const study::StudyPlan& plan = at.plan();
  return std::ranges::all_of(rules, [&](const rules::EffectRule& rule) {
    if (!rules::covers(rule, name)) return true;
    const std::vector<ValueLimits> limits =
        study::limits_at(plan, study::slots_named(plan.table, rule.depends_on), at.points().front());
    return !study::are_readable(limits) || rule.has_effect(limits);
  });
}

/// Whether the parameter can be a cause of failures at the point, for reasons that are no effect rules.
bool can_be_a_cause(const PointEdit& at, std::string_view name) {
  // The error is measured with the fine encoder, whichever closes the loop.
  if (is_within(name, "encoder.coarse_errors")) return encoders_of(at).coarse;
  // An integral holds the load: it goes with the disturbance.
  if (name == "initial.integral") return !can_differ_from(0.0, at.limits("disturbance.torque"));
  // A law without a Stribeck velocity has one level of friction.
  if (name == "friction.coulomb_ratio") {
    const auto model =
        static_cast<friction::FrictionModel>(static_cast<int>(at.limits("friction.model").low));
    return friction::uses(friction::traits_of(model), &friction::FrictionParameters::stribeck_velocity);
  }
  return true;
}

/// Whether other gains may be better without it, because the loop is another one.
bool changes_the_loop(std::string_view name) {
  return is_within(name, "controller") || is_within(name, "amplifier");
}

/// "no ripple disturbance.ripple.0", "no dead band of the error in the coarse phase".
std::string name_of(const parameters::Parameter& row) {
  std::string name(row.ideal->name);
  if (is_within(row.name, "controller.coarse")) name += " in the coarse phase";
  if (parameters::without_indices(row.name) != row.name)
    name += fmt::format(" {}", row.name.substr(0, row.name.rfind('.')));
  return name;
}

/// An effect for each parameter that has another value than its ideal one.
void add_ideal_values(const PointEdit& at, std::vector<Effect>& all) {
  const std::vector<rules::EffectRule> rules = rules::effect_rules(at.plan());
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (!row.ideal || !row.ideal->value || !parameters::exists_on(row, at.plan().units.axis)) return;
    const double ideal = *row.ideal->value;
    if (!can_differ_from(ideal, at.limits(row.name)) || !can_be_a_cause(at, row.name) ||
        !acts(at, rules, row.name))
      return;
    all.push_back({.name = name_of(row),
                   .note = changes_the_loop(row.name) ? not_tuned_again : "",
                   .edit = [slot, ideal](PointEdit& edit) { edit.set(slot, ideal); }});
  });
}

// Friction that differs from place to place, or from contact to contact, gets the mean of the track, or the
// value of the first contact.

bool has_friction(const PointEdit& at, const std::function<bool(const study::Value&)>& of_kind) {
  bool found = false;
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    const study::Value* const value = study::value_at_point(at.plan(), slot, at.points().front());
    found = found || (row.profiled != nullptr && value != nullptr && of_kind(*value));
  });
  return found;
}

void with_even_friction(trial::TrialParameters& p) {
  constexpr int places = 256;
  for (const friction::ProfiledParameter& one : p.friction.profiled) {
    double sum = 0.0;
    for (int i = 0; i < places; ++i)
      sum += friction::value_at(*one.profile, 2.0 * std::numbers::pi * i / places);
    p.friction.uniform.*one.parameter = sum / places;
  }
  p.friction.profiled.clear();
}

void add_even_friction(const PointEdit& at, std::vector<Effect>& all) {
  if (has_friction(at, [](const study::Value& value) { return value.kind == study::Value::Kind::profile; }))
    all.push_back({.name = "friction even along the track", .change = with_even_friction});
  if (has_friction(at, study::is_drawn_per_contact))
    all.push_back({.name = "friction equal in all contacts",
                   .change = [](trial::TrialParameters& p) { p.friction.per_contact.clear(); }});
}

// Second mass.

/// The motor carries the load's inertia, and what acts on the load acts on the motor, except its friction.
void with_a_rigid_load(trial::TrialParameters& p) {
  p.plant.inertia += p.plant.load.inertia;
  p.plant.presliding_damping += p.plant.load.damping_to_ground;
  p.plant.sliding_damping += p.plant.load.damping_to_ground;
  p.plant.load = {};
  const trial::DisturbanceParameters& of_load = p.load_side.disturbance;
  p.disturbance.torque += of_load.torque;
  const auto append = [](auto& to, const auto& more) { to.insert(to.end(), more.begin(), more.end()); };
  append(p.disturbance.ripple, of_load.ripple);
  append(p.disturbance.vibration, of_load.vibration);
  append(p.disturbance.spectra, of_load.spectra);
  p.load_side = {};
}

// Converter. Its range and its non-linearity stay, the latter in codes.

void with_finer_converter(PointEdit& at) {
  constexpr std::int64_t more_bits = 4;
  constexpr double ratio = 1 << more_bits;
  at.add("dac.bits", more_bits);
  at.scale("dac.resolution", 1.0 / ratio);
  at.scale("dac.nonlinearity", ratio);
}

/// Of a step that the limit tames a range without end is not the best one: three are tried.
constexpr std::array<int, 3> wider_ranges{2, 10, 50};

/// A code becomes no smaller, so that the range alone can help.
void with_wider_torque_range(PointEdit& at, int ratio) {
  const auto more_bits = static_cast<std::int64_t>(std::floor(std::log2(ratio)));
  at.add("dac.bits", more_bits);
  at.scale("amplifier.limit", ratio);
  at.scale("dac.range", ratio);  // where it is given, the resolution follows from it
  at.scale("dac.resolution", ratio / std::exp2(more_bits));
}

// Encoder. All lengths that the manifest gives in counts stay the same in rad or m, and so do gains per
// count. Counts of the control, the command and the verdict are those of the fine encoder, whichever closes
// the loop.

constexpr double counts_per_count = 4.0;

void refine(PointEdit& at, std::string_view per_revolution, std::string_view length,
            std::string_view errors) {
  const bool rotary = at.plan().units.axis == parameters::AxisKind::rotary;
  at.scale(rotary ? per_revolution : length, rotary ? counts_per_count : 1.0 / counts_per_count);
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (row.unit == "count" && is_within(row.name, errors)) at.scale(slot, counts_per_count);
  });
}

void keep_lengths_in_fine_counts(PointEdit& at) {
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    const bool of_an_encoder = is_within(row.name, "encoder") || row.name == "initial.encoder_phase" ||
                               row.name == "initial.load_encoder_phase";
    if ((row.unit == "count" && !of_an_encoder) || row.unit == "count/sample")
      at.scale(slot, counts_per_count);
    if (is_sampled_gain(at, row)) at.scale(slot, 1.0 / counts_per_count);
  });
  trial::ErrorBands& bands = at.plan().common.verdict.bands;
  for (std::size_t b = 0; b < bands.count; ++b) {
    constexpr auto whole = static_cast<std::int64_t>(counts_per_count);
    bands.limits[b] = whole * bands.limits[b] + whole / 2;  // (b + 1/2) counts to either side of the middle
  }
}

void with_finer_encoder(PointEdit& at) {
  const LoopEncoders encoders = encoders_of(at);
  if (encoders.coarse) refine(at, "encoder.coarse", "encoder.coarse_resolution", "encoder.coarse_errors");
  if (!encoders.fine) return;
  refine(at, "encoder.fine", "encoder.resolution", "encoder.fine_errors");
  keep_lengths_in_fine_counts(at);
}

/// With an encoder on each mass counts are those of the one that closes the position loop.
void with_finer_encoder_of(PointEdit& at, motion::EncoderPlace mass, motion::EncoderPlace closing) {
  if (mass == motion::EncoderPlace::motor) {
    refine(at, "encoder.fine", "encoder.resolution", "encoder.fine_errors");
  } else {
    refine(at, "encoder.load.counts_per_revolution", "encoder.load.resolution", "encoder.load.fine_errors");
  }
  if (mass == closing) keep_lengths_in_fine_counts(at);
}

/// One effect, or with an encoder on each mass one for each.
void add_finer_encoders(const PointEdit& at, const std::string& refusal, std::vector<Effect>& all) {
  using enum motion::EncoderPlace;
  const std::vector<ValueLimits> limits = study::limits_at(
      at.plan(), study::slots_named(at.plan().table, study::two_encoders), at.points().front());
  Effect finer{.name = std::string(parameters::finer_encoder),
               .note = not_tuned_again,
               .refusal = refusal,
               .edit = with_finer_encoder};
  if (!study::has_two_encoders(limits)) return all.push_back(std::move(finer));
  for (const motion::EncoderPlace mass : {motor, load}) {
    finer.name = fmt::format("{} on the {}", parameters::finer_encoder, study::mass_text(mass));
    finer.edit = [mass, closing = study::closes_at_load(limits) ? load : motor](PointEdit& edit) {
      with_finer_encoder_of(edit, mass, closing);
    };
    all.push_back(finer);
  }
}

// Sample rate. Times, rates and gains stay the same in s; what is given in samples, the delay, stays in
// samples.

constexpr double rate_ratio = 2.0;

/// The factor of a gain of the sampled law that stays the same in SI units.
double factor_at_new_rate(std::string_view si_unit) {
  if (si_unit.ends_with("/(rad s)")) return 1.0 / rate_ratio;
  return si_unit.ends_with(" s/rad") ? rate_ratio : 1.0;
}

void with_twice_the_rate(PointEdit& at) {
  at.scale("controller.sample_rate", rate_ratio);
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (row.unit == "count/sample") at.scale(slot, 1.0 / rate_ratio);
    if (is_sampled_gain(at, row)) at.scale(slot, factor_at_new_rate(row.si_unit));
  });
}

/// Coefficients belong to a sample rate.
void resample_biquads(trial::TrialParameters& p) {
  for (std::vector<loop::Filter>* filters :
       {&p.controller.blocks.filters, &p.controller.coarse.blocks.filters}) {
    for (loop::Filter& filter : *filters) {
      if (filter.kind != loop::FilterKind::biquad) continue;
      const std::optional<loop::Filter> resampled = loop::resampled(filter, rate_ratio);
      if (!resampled)
        throw Failure(ExitCode::bad_input,
                      "a biquad with a pole at half the sample rate is of no other sample rate");
      filter = *resampled;
    }
  }
}

// Disturbance.

/// A load goes together with what holds it at the start: the integral against it, up to the largest load of
/// the study, a contact that carries it, and a preload of its size.
Change without_constant_disturbance(const ValueLimits& load) {
  return [load](trial::TrialParameters& p) {
    double& integral = p.initial.integral;
    integral = integral > 0.0 ? std::max(0.0, integral - std::max(0.0, -load.low))
                              : std::min(0.0, integral + std::max(0.0, load.high));
    constexpr double rounding = 1e-9;
    const double torque = std::abs(p.disturbance.torque);
    if (torque > 0.0 && std::abs(std::abs(p.initial.preload) - torque) <= rounding * torque)
      p.initial.preload = 0.0;
    // Torques on a second mass stay, and must be held at the start as before.
    if (!motion::has_load(p.plant)) p.initial.holding = false;
    p.disturbance.torque = 0.0;
  };
}

/// A spectrum is no parameter. It stays in the list, so that the others keep their random numbers.
Effect without_spectrum(const std::shared_ptr<const trial::SpectrumParameters>& spectrum,
                        std::size_t number) {
  auto quiet = std::make_shared<trial::SpectrumParameters>(*spectrum);
  for (trial::SpectrumPoint& point : quiet->density) point.density = 0.0;
  return {.name = fmt::format("no vibration of spectrum {}", number),
          .change = [spectrum, silent = std::shared_ptr<const trial::SpectrumParameters>(std::move(quiet))](
                        trial::TrialParameters& p) {
            std::ranges::replace(p.disturbance.spectra, spectrum, silent);
            std::ranges::replace(p.load_side.disturbance.spectra, spectrum, silent);
          }};
}

/// The constant disturbance, each spectrum and, where there are several disturbances, all of them together.
/// @param all has those of ripples and vibrations
void add_disturbances(const PointEdit& at, std::vector<Effect>& all) {
  const ValueLimits torque = at.limits("disturbance.torque");
  const Change without_torque = without_constant_disturbance(torque);
  auto disturbances = std::ranges::count_if(
      all, [](const Effect& effect) { return effect.name.find(" disturbance.") != std::string::npos; });
  if (can_differ_from(0.0, torque)) {
    all.push_back({.name = std::string(parameters::no_constant_disturbance), .change = without_torque});
    ++disturbances;
  }
  auto spectra = at.plan().common.disturbance.spectra;
  const auto& of_load = at.plan().common.load_side.disturbance.spectra;
  spectra.insert(spectra.end(), of_load.begin(), of_load.end());
  for (std::size_t i = 0; i < spectra.size(); ++i) all.push_back(without_spectrum(spectra[i], i));
  if (disturbances + std::ssize(spectra) > 1)
    all.push_back({.name = "no disturbance", .change = [without_torque](trial::TrialParameters& p) {
                     without_torque(p);
                     p.disturbance = {};
                     p.load_side.disturbance = {};
                   }});
}

}  // namespace

std::vector<Effect> idealisations_of(const study::Study& study, std::int64_t point) {
  const PointEdit at(study, point);
  const std::string belongs =
      study.plan->plugin ? "the parameters of a plugin belong to its sample rate and encoder" : "";
  std::vector<Effect> all;
  add_ideal_values(at, all);
  add_even_friction(at, all);
  add_disturbances(at, all);
  if (can_differ_from(0.0, at.limits("plant.load.inertia")))
    all.push_back(
        {.name = std::string(parameters::rigid_axis), .note = not_tuned_again, .change = with_a_rigid_load});
  const auto no_friction = static_cast<double>(friction::LoadFrictionModel::none);
  if (can_differ_from(no_friction, at.limits("plant.load.friction.model")))
    all.push_back({.name = "no friction of the load",
                   .change = [](trial::TrialParameters& p) { p.load_side.friction = {}; }});
  all.push_back({.name = std::string(parameters::finer_converter), .edit = with_finer_converter});
  for (const int ratio : wider_ranges)
    all.push_back({.name = fmt::format("a torque range {} times wider", ratio),
                   .edit = [ratio](PointEdit& edit) { with_wider_torque_range(edit, ratio); }});
  add_finer_encoders(at, belongs, all);
  all.push_back({.name = std::string(parameters::faster_sampling),
                 .note = not_tuned_again,
                 .refusal = belongs,
                 .edit = with_twice_the_rate,
                 .change = resample_biquads});
  return all;
}

std::vector<std::string> sections_with_other_values() {
  std::vector<std::string> sections;
  for (const parameters::Parameter& row : parameters::parameter_table()) {
    const std::string section(row.name.substr(0, row.name.find('.')));
    if (!row.ideal && std::ranges::find(sections, section) == sections.end()) sections.push_back(section);
  }
  return sections;
}

}  // namespace zerocount::tuning
