#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/study/measured_machines.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/setting_study.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

namespace zerocount::tuning {
namespace {

constexpr double tail = 0.0005;  // beyond each end of the box

/// Whether any of the inputs is drawn with a correlation to another value.
bool are_correlated(const std::vector<study::MachineInput>& inputs, const study::StudyPlan& plan) {
  return std::ranges::any_of(inputs, [&](const study::MachineInput& input) {
    return plan.copula &&
           std::ranges::find(plan.copula->slots, input.slots.front()) != plan.copula->slots.end();
  });
}

/// The study, changed so that any number of trials can be drawn independently of each other. Its profiles
/// (parameters that vary along the axis) are kept.
study::Study searched_study(const study::Study& study, const std::vector<study::MachineInput>& inputs) {
  study::Study searched = study;
  if (are_correlated(inputs, *study.plan)) {
    auto plan = std::make_shared<study::StudyPlan>(*study.plan);
    plan->copula.reset();
    searched.plan = std::move(plan);
    searched.correlations.clear();
  }
  searched.design = study::Design::monte_carlo;
  return searched;
}

std::string not_one_number(std::string_view name) {
  return fmt::format(
      "{} changes with age, and is drawn per study or contact: the manifest of a machine cannot hold its "
      "aged value",
      name);
}

/// Factor by which the age of the machine multiplies a value; 1 for a value without aging.
/// @param values drawn values of the machine, from which the aging rate is taken
double age_factor(const MachineBox& box, const study::Value& value, const NamedValues& values) {
  if (!value.aging) return 1.0;
  const study::StudyPlan& plan = *box.study().plan;
  const auto point = static_cast<std::size_t>(box.point());
  const study::Aging& aging = plan.agings[*value.aging];
  const auto drawn =
      std::ranges::find(values, plan.table.rows[aging.rate].name, &NamedValues::value_type::first);
  return study::factor_at_age(
      aging, drawn != values.end() ? drawn->second : study::range_of_slot(plan, aging.rate, point).typical,
      study::age_at(plan, point));
}

/// Replaces the values at age 0 by the values at the machine's age, because the manifest that describes one
/// machine has no ages.
/// @throws Failure (bad_input) if a value with aging is not one number for the machine
void let_act_at_age(manifest_text::PointChanges& changes, const MachineBox& box) {
  const study::StudyPlan& plan = *box.study().plan;
  if (plan.ages.empty()) return;
  const NamedValues drawn = changes.values;
  std::erase_if(changes.values, [](const auto& one) { return one.first.ends_with(study::suffix_of_rate); });
  changes.removed.emplace_back("ages");
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
    const study::Value& value = *study::value_at_point(plan, slot, static_cast<std::size_t>(box.point()));
    if (!value.aging) continue;
    const std::string name(plan.table.rows[slot].name);
    const double factor = age_factor(box, value, drawn);
    const auto known = std::ranges::find(changes.values, name, &NamedValues::value_type::first);
    if (known != changes.values.end()) {
      known->second *= factor;
    } else if (value.kind == study::Value::Kind::number) {
      changes.values.emplace_back(name, factor * value.number);
    } else if (value.kind == study::Value::Kind::profile) {
      changes.removed.push_back(name + ".aging");
      if (const study::Rotors& rotors = *plan.profiles[value.index]; !rotors.drawn_mean())
        changes.values.emplace_back(name + ".profile.mean", factor * rotors.mean(0));
    } else {
      throw Failure(ExitCode::bad_input, not_one_number(name));
    }
  }
}

/// Replaces the distribution of the mean of each profile (a parameter that varies along the axis) by the mean
/// drawn for this machine.
void hold_means_of_profiles(manifest_text::PointChanges& changes, const MachineBox& box,
                            const BoxPoint& point, const NamedValues& values) {
  const study::StudyPlan& plan = *box.study().plan;
  for (const auto& [slot, value] : box.profiles()) {
    const study::Rotors& rotors = *plan.profiles[value->index];
    if (rotors.drawn_mean())
      changes.values.emplace_back(
          fmt::format("{}.profile.mean", plan.table.rows[slot].name),
          age_factor(box, *value, values) *
              rotors.mean(value->level == study::DrawLevel::machine ? point.machine : 0));
  }
}

}  // namespace

double quantile_at(double place) {
  return tail + (1.0 - 2.0 * tail) * place;
}

double place_at(double quantile) {
  return std::clamp((quantile - tail) / (1.0 - 2.0 * tail), 0.0, 1.0);
}

MachineBox::MachineBox(study::Study study, std::int64_t point)
    : given_(std::move(study)),
      point_(point),
      inputs_(study::machine_inputs(given_, point)),
      searched_(searched_study(given_, inputs_)) {
  if (inputs_.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: it draws nothing that differs between machines; expected distributions, "
                              "such as friction.k1: {{lognormal: {{median: 110, cv: 0.1}}}}",
                              given_.name));
  const auto values = study::values_at(*given_.plan, static_cast<std::size_t>(point_));
  for (std::size_t slot = 0; slot < values.size(); ++slot) {
    if (values[slot]->kind != study::Value::Kind::profile) continue;
    profiles_.emplace_back(slot, values[slot]);
    has_profile_per_machine_ |= values[slot]->level == study::DrawLevel::machine;
  }
}

BoxPoint MachineBox::machine_of(std::int64_t machine) const {
  return {given_.machines > 0 ? machine : 0, study::drawn_quantiles(given_, point_, machine, inputs_)};
}

/// Σ z² of the normal scores of the machine's inputs, divided by its limit for likely machines; above 1 the
/// machine is outside the region. 0 for MachineRegion::box.
double MachineBox::excess_of(const BoxPoint& point, MachineRegion region) const {
  double square = 0.0;
  int scores = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (region == MachineRegion::box || is_row(i)) continue;
    const double z = numerics::normal_quantile(point.quantiles[i]);
    square += z * z;
    ++scores;
  }
  return scores == 0 ? 0.0 : square / statistics::chi_squared_quantile(scores, 1.0 - 2.0 * tail);
}

void MachineBox::approach_median(BoxPoint& point, double divisor) const {
  for (std::size_t i = 0; i < point.quantiles.size(); ++i) {
    if (is_row(i)) continue;
    double& one = point.quantiles[i];
    one = numerics::normal_probability(numerics::normal_quantile(one) / divisor);
  }
}

BoxPoint MachineBox::inside(BoxPoint point, MachineRegion region) const {
  for (double& one : point.quantiles) one = std::clamp(one, tail, 1.0 - tail);
  if (const double excess = excess_of(point, region); excess > 1.0) approach_median(point, std::sqrt(excess));
  // Measured values at the ends of their ranges may be those of no machine.
  const auto is_machine = [&] {
    return study::is_machine(searched_, point_, point.machine, draws_of(point, given_.trials));
  };
  constexpr int max_steps = 100;
  for (int step = 0; step < max_steps && !is_machine(); ++step) approach_median(point, 1.1);
  return point;
}

bool MachineBox::is_likely(const BoxPoint& point) const {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < point.quantiles.size(); ++i) {
    const double one = point.quantiles[i];
    if (!is_row(i) && (one < tail - rounding || one > 1.0 - tail + rounding)) return false;
  }
  return excess_of(point, MachineRegion::likely) <= 1.0 + rounding;
}

study::GivenDraws MachineBox::draws_of(const BoxPoint& point, std::int64_t number) const {
  study::GivenDraws given;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    for (const std::uint32_t slot : inputs_[i].slots) given.uniforms[slot] = point.quantiles[i];
  }
  given.number = number;
  given.rotor = point.machine;
  return given;
}

trial::TrialParameters MachineBox::trial_of(const BoxPoint& point, std::int64_t number) const {
  return study::study_trial(searched_, point_, point.machine, draws_of(point, number)).parameters;
}

std::int64_t machines_of_manifest(const MachineBox& box, const BoxPoint& point) {
  return box.has_profile_per_machine() ? std::max<std::int64_t>(point.machine + 1, 2) : 1;
}

std::string manifest_of(const MachineBox& box, const BoxPoint& point, const NamedValues& values,
                        const MachineManifest& manifest) {
  const study::Study& study = box.study();
  manifest_text::PointChanges changes{
      .condition = manifest.condition, .values = values, .folder = manifest.folder.value_or("")};
  changes.removed = {"design", "worlds", "retain"};
  let_act_at_age(changes, box);
  if (are_correlated(box.inputs(), *study.plan)) changes.removed.emplace_back("correlation");
  hold_means_of_profiles(changes, box, point, values);
  for (const study::MachineInput& input : box.inputs()) {
    const std::vector<std::uint32_t>& rows = study.plan->sampled_slots;
    if (std::ranges::find(rows, input.slots.front()) != rows.end()) changes.removed.emplace_back("samples");
  }
  const std::int64_t machines = machines_of_manifest(box, point);
  changes.keys.emplace_back("trials", fmt::format("{}", manifest.trials * machines));
  if (box.has_profile_per_machine()) {
    changes.keys.emplace_back("machines", fmt::format("{}", machines));
  } else {
    changes.removed.emplace_back("machines");
    for (const study::Goal& goal : study.goals)
      changes.removed.push_back(goal.name.empty() ? "goal.machines" : "goals." + goal.name + ".machines");
  }
  // A profile is drawn with the seed.
  if (box.profiles().empty()) changes.keys.emplace_back("seed", fmt::format("{}", study.seed + 1));
  return manifest_text::manifest_of_point(study, box.point(), changes);
}

std::string refusal_of_manifests(const study::Study& study, std::int64_t point) {
  const study::StudyPlan& plan = *study.plan;
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting) {
    for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
      const study::Value& value = *study::value_at_point(plan, slot, study::plan_point(plan, point, setting));
      const bool is_shared =
          value.level == study::DrawLevel::contact || value.level == study::DrawLevel::study;
      if (value.aging && value.kind == study::Value::Kind::distribution && is_shared)
        return not_one_number(plan.table.rows[slot].name);
    }
  }
  return "";
}

}  // namespace zerocount::tuning
