#include "runners/tuning/effects/idealisations.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "core/friction/friction_model.hpp"
#include "core/friction/law.hpp"
#include "core/friction/profile.hpp"
#include "core/loop/dac.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::tuning {

void visit_values(const study::PointEdit& at,
                  const std::function<void(std::size_t slot, const parameters::Parameter& row)>& visit) {
  const study::StudyTable& table = at.plan().table;
  for (const std::size_t slot : study::slots_in_table_order(table)) visit(slot, table.rows[slot]);
}

bool is_sampled_gain(const study::PointEdit& at, const parameters::Parameter& row) {
  return !row.si_unit.empty() && at.plan().units.gains == parameters::GainUnits::count;
}

bool acts(const IdealisedPoint& point, std::string_view name) {
  const study::StudyPlan& plan = point.at.plan();
  return std::ranges::all_of(point.rules, [&](const rules::EffectRule& rule) {
    if (!rules::covers(rule, name)) return true;
    const std::vector<study::ParameterRange> ranges =
        study::ranges_at(plan, study::slots_named(plan.table, rule.depends_on), point.at.points().front());
    return !study::are_readable(ranges) || rule.has_effect({rule.depends_on, ranges});
  });
}

std::string name_in_phase(std::string_view effect, std::string_view parameter) {
  return std::string(effect) + (is_within(parameter, "controller.coarse") ? " in the coarse phase" : "");
}

namespace {

using study::ParameterRange;
using study::PointEdit;

// Ideal values.

/// Whether, in some trial of the point, a disturbance torque may act from the start on. The controller's
/// initial integral then holds it.
bool can_have_load_torque(const PointEdit& at) {
  bool found = can_differ_from(0.0, at.limits(parameter::disturbance::torque)) ||
               can_differ_from(0.0, at.limits(parameter::disturbance::load::torque));
  visit_values(at, [&](std::size_t, const parameters::Parameter& row) {
    const std::string pattern = parameters::without_indices(row.name);
    found = found || ((pattern == parameter::disturbance::ripple::amplitude ||
                       pattern == parameter::disturbance::load::ripple::amplitude) &&
                      parameters::has_value(row) && can_differ_from(0.0, at.limits(row.name)));
  });
  return found;
}

/// Whether the parameter can be a cause of failures at the point. This covers only exceptions, such as an
/// integral that goes with the disturbance it holds; whether the parameter acts at all is checked elsewhere.
bool can_be_a_cause(const PointEdit& at, std::string_view name) {
  // The error is measured with the fine encoder, whichever closes the loop.
  if (is_within(name, "encoder.coarse_errors")) return encoders_of(at).coarse;
  // An integral holds the load: it goes with the disturbance.
  if (name == parameter::initial::integral) return !can_have_load_torque(at);
  // A sine or a record may begin in motion, and the axis with it.
  if (name == parameter::initial::velocity)
    return !loop::moves_for_ever(static_cast<loop::ReferenceShape>(
        static_cast<int>(at.limits(parameter::command::profile::shape).low)));
  // A law without a Stribeck velocity has one level of friction.
  if (name == parameter::friction::coulomb_ratio) {
    const auto model =
        static_cast<friction::FrictionModel>(static_cast<int>(at.limits(parameter::friction::model).low));
    return friction::uses(friction::traits_of(model), &friction::FrictionParameters::stribeck_velocity);
  }
  if (name == parameter::plant::load::friction::coulomb_ratio)
    return at.limits(parameter::plant::load::friction::model).low !=
           static_cast<double>(friction::LoadFrictionModel::dahl);
  return true;
}

/// Whether the control loop is so different without the effect of this parameter that other gains may be
/// better.
bool changes_the_loop(std::string_view name) {
  return is_within(name, "controller") || is_within(name, "amplifier");
}

/// Name of the effect whose parameter takes its ideal value: "no ripple disturbance.ripple.0", "no dead band
/// of the error in the coarse phase".
std::string name_of(const parameters::Parameter& row) {
  std::string name = name_in_phase(row.ideal->name, row.name);
  if (parameters::without_indices(row.name) != row.name)
    name += fmt::format(" {}", row.name.substr(0, row.name.rfind('.')));
  return name;
}

/// Adds to `all`, for each parameter whose value differs from its ideal value, an effect that gives it the
/// ideal value.
void add_ideal_values(const IdealisedPoint& point, std::vector<Effect>& all) {
  visit_values(point.at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (!row.ideal || !row.ideal->value || !parameters::exists_on(row, point.at.plan().units.axis)) return;
    const double ideal = *row.ideal->value;
    if (!can_differ_from(ideal, point.at.limits(row.name)) || !can_be_a_cause(point.at, row.name) ||
        !acts(point, row.name))
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

// Converter. Its range and its non-linearity stay, the latter in codes.

void with_finer_converter(PointEdit& at) {
  constexpr std::int64_t more_bits = 4;
  constexpr double ratio = 1 << more_bits;
  at.add(parameter::dac::bits, more_bits);
  at.scale(parameter::dac::resolution, 1.0 / ratio);
  at.scale(parameter::dac::nonlinearity, ratio);
}

/// Factors by which the torque range of the drive is widened, one effect each. If the torque limit already
/// tames the response to a step, an infinite range need not be the best, so three are tried.
constexpr std::array<int, 3> wider_ranges{2, 8, 50};

/// Effect with a torque range that is `ratio` times wider. The step of the digital-to-analogue converter
/// keeps its size, so that the range alone can help. If the ratio is not a power of two, the converter gets
/// the next power of two, and the amplifier limits the torque.
Effect with_wider_torque_range(int ratio) {
  const int more_bits = std::bit_width(static_cast<unsigned>(ratio - 1));
  const double converter_ratio = std::exp2(more_bits);
  Effect effect{.name = fmt::format("{} {} times wider", parameters::wider_torque_range, ratio),
                .edit = [ratio, more_bits, converter_ratio](PointEdit& at) {
                  at.add(parameter::dac::bits, more_bits);
                  at.scale(parameter::amplifier::limit, ratio);
                  at.scale(parameter::dac::range,
                           converter_ratio);  // the resolution follows from it, and stays
                }};
  if (converter_ratio != ratio)
    effect.change = [part = ratio / converter_ratio](trial::TrialParameters& p) {
      p.dac.limit = std::min(p.dac.limit, -part * p.dac.resolution * static_cast<double>(lowest_code(p.dac)));
    };
  return effect;
}

void add_drive_effects(std::vector<Effect>& all) {
  all.push_back({.name = std::string(parameters::finer_converter), .edit = with_finer_converter});
  for (const int ratio : wider_ranges) all.push_back(with_wider_torque_range(ratio));
}

}  // namespace

std::vector<Effect> idealisations_of(const study::Study& study, std::int64_t number) {
  const PointEdit at(study, number);
  const IdealisedPoint point{
      at, rules::effect_rules(at.plan()),
      study.plan->plugin ? "the parameters of a plugin belong to its sample rate and encoder" : ""};
  std::vector<Effect> all;
  add_ideal_values(point, all);
  add_even_friction(at, all);
  add_disturbances(point, all);
  add_rigid_axis(point, all);
  const auto no_friction = static_cast<double>(friction::LoadFrictionModel::none);
  if (acts(point, parameter::plant::load::friction::model) &&
      can_differ_from(no_friction, at.limits(parameter::plant::load::friction::model)))
    all.push_back({.name = std::string(parameters::no_load_friction),
                   .change = [](trial::TrialParameters& p) { p.load_side.friction = {}; }});
  add_control_effects(point, all);
  add_drive_effects(all);
  add_finer_encoders(point, study, all);
  add_faster_sampling(point, all);
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
