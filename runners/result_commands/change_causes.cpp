#include "runners/result_commands/change_causes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_edit.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study_table.hpp"
#include "experiments/study/study_trial.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::result_commands {
namespace {

using monitor::ChangeKind;
using Trial = trial::TrialParameters;

const std::vector<double> factors{0.35, 0.6, 0.84, 1.0, 1.19, 1.67, 2.8};
const std::vector<double> whole_counts{0.0, 1.0, 2.0, 4.0, 9.0};

/// Whether the parameter is a real number that can change while a machine is in use. The length of a count,
/// phases and rates of aging cannot.
bool can_change(const parameters::Parameter& row) {
  constexpr std::array sections{"plant.",     "friction.",   "encoder.",    "dac.",
                                "amplifier.", "controller.", "disturbance."};
  const std::string_view name = row.name;
  const bool is_in_section =
      std::ranges::any_of(sections, [&](std::string_view section) { return name.starts_with(section); });
  const bool is_length_of_count = row.unit == "m/count";
  const bool is_phase = name.ends_with("phase") || name.ends_with("_angle");
  return is_in_section && row.kind == parameters::ParameterKind::real && !is_length_of_count && !is_phase &&
         !name.ends_with(study::suffix_of_rate);
}

/// Sizes of a machine, from which the amounts are derived that are added to its parameters.
struct Scales {
  /// Breakaway torque (force) of the friction; without friction 1/100 of the converter's range, N m or N.
  double torque;
  double count;  ///< Length of a count of the encoder that closes the loop, rad or m.
  bool has_load;
};

Scales scales_of(const Trial& trial) {
  const double range = std::ldexp(trial.dac.resolution, trial.dac.bits - 1);
  const bool has_load = motion::has_load(trial.plant);
  double torque =
      trial.friction.model == friction::FrictionModel::none ? 0.0 : trial.friction.uniform.breakaway;
  if (has_load && trial.load_side.friction.model != friction::LoadFrictionModel::none)
    torque += trial.load_side.friction.contact.breakaway;
  return {torque > 0.0 ? torque : 0.01 * range, loop::fine_resolution(trial.encoder), has_load};
}

std::vector<double> multiples(double scale, std::vector<double> numbers) {
  for (double& number : numbers) number *= scale;
  return numbers;
}

/// Makes a zone of errors wider by `amount`. A negative bound means that there is no zone, so it counts as 0.
void widen(double& bound, double amount) {
  bound = std::max(bound, 0.0) + amount;
}

/// Parameters of a machine to which an amount may be added if they are 0 or "none", such as encoder noise.
std::vector<Cause> amounts_of(const Trial& trial) {
  const Scales scales = scales_of(trial);
  const std::vector<double> torques = multiples(scales.torque, {-0.7, -0.3, -0.1, 0.0, 0.1, 0.3, 0.7});
  std::vector<Cause> causes{
      {std::string(parameter::encoder::fine_errors::noise),
       "",
       ChangeKind::amount,
       {0.0, 0.05, 0.1, 0.2, 0.4, 0.8},
       // Where the load's encoder closes the loop, it has changed places with the motor's.
       [](Trial& p, double amount) {
         const bool exchanged =
             loop::has_other(p.encoder) && p.plant.load.encoder == motion::EncoderPlace::load;
         (exchanged ? p.encoder.other.errors : p.encoder.fine_errors).noise += amount;
       }},
      {std::string(parameter::controller::delay),
       "",
       ChangeKind::amount,
       {0.0, 0.5, 1.0, 2.0, 3.0},
       [](Trial& p, double amount) { p.controller.delay += amount; }},
      {std::string(parameter::controller::deadband::enter), "", ChangeKind::amount, whole_counts,
       [](Trial& p, double amount) { widen(p.controller.blocks.deadband.enter, amount); }},
      {std::string(parameter::controller::error_deadband::band), "", ChangeKind::amount, whole_counts,
       [](Trial& p, double amount) { widen(p.controller.blocks.error_deadband.band, amount); }},
      // Factors of the torque less one: the gain error stays above -1.
      {std::string(parameter::dac::gain_error),
       "",
       ChangeKind::amount,
       {-0.5, -0.3, -0.13, 0.0, 0.15, 0.43, 1.0},
       [](Trial& p, double amount) { p.dac.gain_error += amount * (1.0 + p.dac.gain_error); }},
      {std::string(parameter::dac::offset), "", ChangeKind::amount, torques,
       [](Trial& p, double amount) { p.dac.offset += amount; }},
      {std::string(parameter::disturbance::torque), "", ChangeKind::amount, torques,
       [](Trial& p, double amount) { p.disturbance.torque += amount; }}};
  if (!scales.has_load) return causes;
  causes.push_back({std::string(parameter::plant::load::gap), "", ChangeKind::amount,
                    multiples(scales.count, {0.0, 1.0, 5.0, 20.0, 80.0, 300.0}),
                    [](Trial& p, double amount) { p.plant.load.gap += amount; }});
  causes.push_back({std::string(parameter::disturbance::load::torque), "", ChangeKind::amount, torques,
                    [](Trial& p, double amount) { p.load_side.disturbance.torque += amount; }});
  return causes;
}

/// Whether the parameter is 0 or "none" in all trials.
bool is_absent(const parameters::Parameter& row, const study::ParameterRange& range) {
  return range.low == range.high && (range.low == 0.0 || range.low == row.none);
}

}  // namespace

std::vector<Cause> causes_of(const study::Study& study, std::int64_t point) {
  const study::StudyPlan& plan = *study.plan;
  const std::size_t place = study::plan_point(plan, point);
  const std::vector<rules::EffectRule> rules = rules::effect_rules(plan);
  const std::vector<Cause> amounts = amounts_of(study::study_trial(study, point, 0).parameters);
  std::vector<Cause> causes;
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    const parameters::Parameter& row = plan.table.rows[slot];
    if (!can_change(row) || !parameters::exists_on(row, plan.units.axis) ||
        !rules::has_effect(plan, rules, row.name))
      continue;
    const study::Value* const value = study::value_at_point(plan, slot, place);
    if (value == nullptr || value->kind == study::Value::Kind::profile ||
        value->kind == study::Value::Kind::derived)
      continue;
    const study::ParameterRange range = study::range_of_slot(plan, slot, place);
    if (!std::isfinite(range.low) || !std::isfinite(range.high)) continue;
    const auto amount = std::ranges::find(amounts, row.name, &Cause::name);
    const bool is_added = amount != amounts.end() &&
                          (is_absent(row, range) || row.name == std::string_view(parameter::dac::gain_error));
    if (is_added) {
      causes.push_back(*amount);
      causes.back().unit = parameters::unit_of(row, plan.units);
      if (causes.back().unit == "1") causes.back().unit.clear();
    } else if (!is_absent(row, range)) {
      causes.push_back({.name = std::string(row.name), .changes = factors});
    }
  }
  return causes;
}

std::optional<study::Study> study_with_factor(const study::Study& study, std::int64_t point,
                                              const Cause& cause, double factor) {
  study::PointEdit edit(study, point);
  edit.scale(cause.name, factor);
  if (!rules::refusal_of(edit).empty()) return std::nullopt;
  return edit.study();
}

bool is_named(std::string_view path, std::string_view name) {
  bool first = true;
  while (!name.empty()) {
    const std::string_view part = name.substr(0, name.find('.'));
    bool found = false;
    while (!path.empty() && !found) {
      const std::string_view step = path.substr(0, path.find('.'));
      path.remove_prefix(std::min(path.size(), step.size() + 1));
      found = step == part;
      if (first && !found) return false;
      first = false;
    }
    if (!found) return false;
    name.remove_prefix(std::min(name.size(), part.size() + 1));
  }
  return !first;
}

std::vector<std::string> unchanged_names(const study::Study& study, const std::vector<std::string>& lists) {
  std::vector<std::string> known;
  for (const parameters::Parameter& row : study.plan->table.rows)
    if (can_change(row)) known.emplace_back(row.name);
  std::vector<std::string> names;
  for (const std::string& list : lists)
    for (std::size_t first = 0, end = 0; end != std::string::npos; first = end + 1) {
      end = list.find(',', first);
      names.push_back(list.substr(first, end == std::string::npos ? end : end - first));
      if (std::ranges::any_of(known, [&](const auto& path) { return is_named(path, names.back()); }))
        continue;
      const std::string_view near = yaml::nearest_name(names.back(), known);
      throw Failure(
          ExitCode::bad_input,
          fmt::format("option '--unchanged': '{}' is not among the parameters that are tried; expected "
                      "real numbers of plant, friction, encoder, dac, amplifier, controller or "
                      "disturbance{}",
                      text::printable(names.back()), near.empty() ? "" : fmt::format(", such as {}", near)));
    }
  return names;
}

}  // namespace zerocount::result_commands
