#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "experiments/designs/designs.hpp"
#include "experiments/manifest/manifest.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/randomness/random_variables.hpp"
#include "experiments/study/effects.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::manifest {
namespace {

// Name of the mean of a profile: its path in the manifest.
std::string profile_mean_name(std::string_view parameter) {
  return fmt::format("{}.profile.mean", parameter);
}

// [slot] whether an axis assigns the slot, or one that it follows.
struct AssignedSlots {
  std::vector<bool> swept;       // by an axis of the sweep
  std::vector<bool> overridden;  // by the axis of the settings, or changed by ages

  bool differs(std::size_t slot) const { return swept[slot] || overridden[slot]; }
};

AssignedSlots assigned_slots(const study::StudyPlan& plan) {
  AssignedSlots slots{std::vector<bool>(plan.base.size(), false), std::vector<bool>(plan.base.size(), false)};
  for (std::size_t axis = 0; axis < plan.axes.size(); ++axis) {
    const bool of_conditions = plan.settings_axis && axis == plan.settings_axis;
    for (const study::Assignment& assignment : plan.axes[axis].assignments)
      (of_conditions ? slots.overridden : slots.swept)[assignment.slot] = true;
  }
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
    if (study::changes_with_age(plan, slot)) slots.overridden[slot] = true;
    if (plan.base[slot].kind != study::Value::Kind::derived) continue;
    for (const std::uint32_t source : plan.derived[plan.base[slot].index].from) {
      slots.swept[slot] = slots.swept[slot] || slots.swept[source];
      slots.overridden[slot] = slots.overridden[slot] || slots.overridden[source];
    }
  }
  return slots;
}

// Whether the slot's value at some design point is drawn anew at each contact.
bool differs_between_contacts(const study::StudyPlan& plan, std::size_t slot) {
  const std::vector<const study::Value*> values = study::values_of(plan, slot);
  return std::any_of(values.begin(), values.end(), [](const study::Value* value) {
    return value->kind == study::Value::Kind::distribution && value->level == study::DrawLevel::contact;
  });
}

// Only input slots are drawn.
void derive_randomness(const study::Study& study, study::StudyPlan& plan) {
  std::vector<std::size_t> dimensions;
  for (const std::uint32_t slot : plan.input_slots)
    dimensions.push_back(plan.table.rows[slot].sobol_dimension);
  const auto directions = study.design == study::Design::sobol
                              ? designs::sobol_directions(dimensions)
                              : std::vector<designs::SobolDirections>(dimensions.size());
  plan.randomness.resize(plan.base.size());
  for (std::size_t i = 0; i < plan.input_slots.size(); ++i) {
    const std::uint32_t slot = plan.input_slots[i];
    const std::string name(plan.table.rows[slot].name);
    study::SlotRandomness& randomness = plan.randomness[slot];
    const bool is_rate = name.ends_with(study::suffix_of_rate);
    randomness = {.key = designs::random_key(study.seed, name),
                  .directions = directions[i],
                  .no_directions = is_rate && study.design == study::Design::sobol};
    if (differs_between_contacts(plan, slot)) {
      randomness.contacts = designs::random_key(study.seed, name + "/contacts");
    }
  }
  for (const study::GroupingTraits& of : study::groupings)
    plan.sobol_places[of.grouping] = study::sobol_place_key(study.seed, of.grouping);
}

// The slots of joint draws share one random number, which selects the row. The slash keeps its name apart
// from parameter names.
void share_randomness_of_samples(const study::Study& study, study::StudyPlan& plan) {
  if (plan.sampled_slots.empty()) return;
  study::SlotRandomness rows{.key = designs::random_key(study.seed, "samples/rows")};
  if (study.design == study::Design::sobol) {
    const std::size_t dimension = parameters::sobol_dimension_of_samples;
    rows.directions = designs::sobol_directions({&dimension, 1}).front();
  }
  rows.contacts = designs::random_key(study.seed, "samples/rows/contacts");
  for (const std::uint32_t slot : plan.sampled_slots) plan.randomness[slot] = rows;
}

void number_factors(study::StudyPlan& plan, study::Study& study) {
  if (study.design != study::Design::saltelli) return;
  plan.factors = randomness::find_factors(plan);
  study.factors = randomness::factor_names(plan);
  plan.factor_of.resize(plan.base.size());
  for (std::size_t f = 0; f < plan.factors.slots.size(); ++f) {
    plan.factor_of[plan.factors.slots[f]] = static_cast<std::uint32_t>(f);
  }
}

// Random keys of the draws during a trial. The slash keeps their names apart from parameter names.
random::TrialRandomness trial_randomness(std::uint64_t seed) {
  random::TrialRandomness keys;
  for (const study::Effect& effect : study::effects())
    if (effect.draws != nullptr) keys.*effect.draws = designs::random_key(seed, effect.key);
  return keys;
}

std::size_t gms_element_count(const study::StudyTable& table) {
  const auto stiffness =
      study::find_list(table, parameters::find_parameter(parameter::friction::gms::stiffness).value());
  return stiffness ? stiffness->count : 0;
}

// Sets the parameters that are the same in all trials.
void set_common_parameters(const study::Study& study, study::StudyPlan& plan) {
  plan.common.randomness = trial_randomness(study.seed);
  plan.common.command.targets.resize(plan.open_loop ? 0 : static_cast<std::size_t>(study.moves));
  plan.common.command.torque.levels.resize(plan.open_loop ? plan.list.count : 0);
  plan.common.friction.gms_elements.resize(gms_element_count(plan.table));
  for (const study::Value& value : plan.base) plan.numbers.push_back(value.number);
  const std::set<std::size_t> inputs(plan.input_slots.begin(), plan.input_slots.end());
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    const parameters::Parameter& parameter = plan.table.rows[slot];
    if (!parameters::exists_on(parameter, plan.units.axis) || !parameter.set) continue;
    if (inputs.count(slot) == 0) parameter.set(plan.common, plan.numbers[slot]);
  }
}

std::string column_meaning(const parameters::Parameter& parameter, const parameters::StudyUnits& units) {
  std::string meaning = parameters::meaning_of(parameter, units);
  for (std::size_t i = 0; i < parameter.labels.size(); ++i) {
    meaning += fmt::format("{}{} {}", i == 0 ? " (" : ", ", i, parameter.labels[i]);
  }
  return parameter.labels.empty() ? meaning : meaning + ")";
}

// How often the slot's value is drawn; the most frequent of all points.
study::DrawLevel most_frequent_level(const study::StudyPlan& plan, std::size_t slot) {
  study::DrawLevel level = study::DrawLevel::study;
  for (const study::Value* value : study::values_of(plan, slot)) {
    switch (value->kind) {
      case study::Value::Kind::number:
        break;
      case study::Value::Kind::distribution:
        level = std::max(level, value->level);
        break;
      case study::Value::Kind::profile:  // its value at the trial's start position
        level = std::max(level, study::DrawLevel::trial);
        break;
      case study::Value::Kind::derived:
        for (const std::uint32_t source : plan.derived[value->index].from)
          level = std::max(level, most_frequent_level(plan, source));
        break;
    }
  }
  return level;
}

// How often the mean of the slot's profile is drawn, if it is drawn at some design point.
std::optional<study::DrawLevel> drawn_mean(const study::StudyPlan& plan, std::size_t slot) {
  std::optional<study::DrawLevel> level;
  for (const study::Value* value : study::values_of(plan, slot)) {
    if (value->kind == study::Value::Kind::profile && plan.profiles[value->index]->drawn_mean())
      level = std::max(level.value_or(value->level), value->level);
  }
  return level;
}

// Lists what all trials of a group share at all points; in each setting that overrides it.
void add_shared(const study::InputColumn& column, study::InputSource source, bool overridden,
                const std::vector<std::string>& settings, std::vector<study::InputColumn>& columns,
                std::vector<study::InputSource>& sources) {
  if (!overridden) {
    columns.push_back(column);
    sources.push_back(source);
    return;
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    columns.push_back(column);
    columns.back().name += study::under_suffix(settings[i]);
    source.setting = static_cast<std::int64_t>(i);
    sources.push_back(source);
  }
}

void add_column(const study::InputColumn& column, const study::InputSource& source,
                const AssignedSlots& assigned, study::StudyPlan& plan, study::Study& study) {
  study.columns.inputs.push_back(column);
  plan.inputs.push_back(source);
  if (assigned.swept[source.slot]) return;
  for (const study::GroupingTraits& of : study::groupings)
    if (of.level == column.level)
      add_shared(column, source, assigned.overridden[source.slot], study::labels_of(study.settings),
                 study.columns.shared[of.grouping], plan.shared_inputs[of.grouping]);
}

void list_input_columns(const AssignedSlots& assigned, study::StudyPlan& plan, study::Study& study) {
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    if (plan.base[slot].kind == study::Value::Kind::number && !assigned.differs(slot)) continue;
    const auto number = static_cast<std::uint32_t>(slot);
    const parameters::Parameter& parameter = plan.table.rows[slot];
    const std::string name(parameter.name);
    const std::string unit = parameters::unit_of(parameter, plan.units);
    plan.input_slots.push_back(number);
    add_column({name, unit, column_meaning(parameter, plan.units), most_frequent_level(plan, slot)},
               {number, false}, assigned, plan, study);
    if (const auto level = drawn_mean(plan, slot)) {
      add_column({profile_mean_name(name), unit, fmt::format("mean of the profile of {}", name), *level},
                 {number, true}, assigned, plan, study);
    }
  }
}

// The used profiles of one slot, each with the first point of the plan that uses it.
std::map<std::uint32_t, std::size_t> profiles_in_use(const study::StudyPlan& plan, std::size_t slot,
                                                     std::size_t points) {
  std::map<std::uint32_t, std::size_t> first_point;
  for (std::size_t point = 0; point < points; ++point) {
    const study::Value& value = *study::value_at_point(plan, slot, point);
    if (value.kind == study::Value::Kind::profile) first_point.emplace(value.index, point);
  }
  return first_point;
}

void list_profiles(const std::vector<keys::ProfileRequest>& requests, const AssignedSlots& assigned,
                   const study::StudyPlan& plan, study::Study& study) {
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    const parameters::Parameter& parameter = plan.table.rows[slot];
    const bool asked =
        std::any_of(requests.begin(), requests.end(), [&](const auto& r) { return r.slot == slot; });
    if (!asked) continue;
    const auto used = profiles_in_use(
        plan, slot, assigned.differs(slot) ? study::plan_point(plan, study::point_count(study)) : 1);
    for (const auto& [index, point] : used) {
      std::string suffix;
      if (used.size() > 1)
        suffix = study::under_suffix(assigned.overridden[slot]
                                         ? study::label_of(study.settings, study::setting_at(plan, point))
                                         : fmt::format("{}", study::design_point(plan, point)));
      const std::shared_ptr<const study::Rotors> rotors = plan.profiles[index];
      study::RealisedProfile profile{std::string(parameter.name) + suffix,
                                     parameters::unit_of(parameter, plan.units), rotors->rotor(0)};
      if (requests[index].level == study::DrawLevel::machine) {
        profile.of_machine = [rotors](std::int64_t machine) { return rotors->rotor(machine); };
      }
      study.profiles.push_back(std::move(profile));
    }
  }
}

study::DrawnMean mean_of(const keys::ProfileRequest& request, const parameters::Parameter& parameter,
                         const study::Study& study) {
  study::DrawnMean mean{*request.form.mean, study.design, {}};
  mean.randomness.key = designs::random_key(study.seed, profile_mean_name(parameter.name));
  if (study.design == study::Design::sobol) {
    const std::size_t dimension = parameters::sobol_dimension_of_mean(parameter.sobol_dimension);
    mean.randomness.directions = designs::sobol_directions({&dimension, 1}).front();
    if (request.level == study::DrawLevel::machine) mean.worlds = static_cast<std::uint64_t>(study.worlds);
    mean.places = study::sobol_place_key(study.seed, study::Grouping::world);
  }
  return mean;
}

}  // namespace

void realise_profiles(const std::vector<keys::ProfileRequest>& requests, const study::Study& study,
                      const std::vector<std::shared_ptr<const study::Rotors>>& known,
                      study::StudyPlan& plan) {
  for (const keys::ProfileRequest& request : requests) {
    const parameters::Parameter& parameter = plan.table.rows[request.slot];
    std::optional<study::DrawnMean> mean;
    if (request.form.mean) mean = mean_of(request, parameter, study);
    const std::int64_t count =
        request.level == study::DrawLevel::machine ? std::max<std::int64_t>(study.machines, 1) : 1;
    auto rotors = std::make_shared<const study::Rotors>(request.form.description, std::move(mean), study.seed,
                                                        parameter.name, count);
    const auto same = std::ranges::find_if(known, [&](const auto& one) { return one->is_same(*rotors); });
    plan.profiles.push_back(same == known.end() ? rotors : *same);
  }
}

void assemble_study(const std::vector<keys::ProfileRequest>& requests,
                    const std::vector<sections::SweptAxis>& axes, study::StudyPlan& plan,
                    study::Study& study) {
  const auto listed = static_cast<std::int64_t>(plan.list.count);
  if (plan.sequence) study.sequence = study::sequence_moves(*plan.sequence, listed);
  study.units = plan.units;
  study.period = plan.period.value_or(study.period);
  study.moves = plan.sequence ? std::ssize(study.sequence) : listed;
  study.open_loop = plan.open_loop;
  study.points.labels = sections::label_points(axes);
  study.points.axes = sections::describe_axes(axes, plan);
  study.features = study::find_features(plan, study);
  const AssignedSlots assigned = assigned_slots(plan);
  list_input_columns(assigned, plan, study);
  derive_randomness(study, plan);
  share_randomness_of_samples(study, plan);
  number_factors(plan, study);
  set_common_parameters(study, plan);
  list_profiles(requests, assigned, plan, study);
}

}  // namespace zerocount::manifest
