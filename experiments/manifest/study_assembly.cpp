#include "experiments/manifest/study_assembly.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "experiments/designs/random_key.hpp"
#include "experiments/study/factors.hpp"
#include "experiments/study/loop_extras.hpp"
#include "experiments/study/outcome_extras.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/slots.hpp"
#include "experiments/study/trace_extras.hpp"

namespace zerocount {
namespace {

// Name of the mean of the profile, as of its place in the manifest.
std::string profile_mean_name(std::string_view parameter) {
  return fmt::format("{}.profile.mean", parameter);
}

// Which slots some axis assigns.
std::vector<bool> swept_slots(const StudyPlan& plan) {
  std::vector<bool> swept(plan.base.size(), false);
  for (const PlanAxis& axis : plan.axes) {
    for (const Assignment& assignment : axis.assignments) swept[assignment.slot] = true;
  }
  return swept;
}

// Whether some value that the slot has at a design point is drawn anew at each contact.
bool differs_between_contacts(const StudyPlan& plan, std::size_t slot) {
  bool found = false;
  visit_points(plan, {&slot, 1}, [&](std::size_t point) {
    const Value& value = *value_at_point(plan, slot, point);
    found = value.kind == Value::Kind::distribution && value.per == Per::contact;
    return !found;
  });
  return found;
}

// Of the input slots: nothing is drawn for the others.
void derive_randomness(const Study& study, StudyPlan& plan) {
  std::vector<std::size_t> dimensions;
  for (const std::uint32_t slot : plan.input_slots) dimensions.push_back(slot_sobol_dimension(slot));
  const auto directions = study.design == Design::sobol ? sobol_directions(dimensions)
                                                        : std::vector<SobolDirections>(dimensions.size());
  plan.randomness.resize(plan.base.size());
  for (std::size_t i = 0; i < plan.input_slots.size(); ++i) {
    const std::uint32_t slot = plan.input_slots[i];
    const std::string name = slot_name(slot, plan.list);
    SlotRandomness& randomness = plan.randomness[slot];
    randomness = {random_key(study.seed, name), directions[i]};
    if (differs_between_contacts(plan, slot)) {
      randomness.contacts = random_key(study.seed, name + "/contacts");
    }
  }
  plan.sobol_places = sobol_place_key(study.seed);
}

void number_factors(StudyPlan& plan, Study& study) {
  if (study.design != Design::saltelli) return;
  plan.factors = find_factors(plan);
  study.factors = factor_names(plan);
  plan.factor_of.resize(plan.base.size());
  for (std::size_t f = 0; f < plan.factors.slots.size(); ++f) {
    plan.factor_of[plan.factors.slots[f]] = static_cast<std::uint32_t>(f);
  }
}

// The keys of what a trial draws while it runs. No parameter has a name with a slash in it.
TrialRandomness trial_randomness(std::uint64_t seed) {
  return {.history = random_key(seed, "initial.history/levels"),
          .fine_noise = random_key(seed, "encoder.fine_errors.noise/samples"),
          .fine_missed = random_key(seed, "encoder.fine_errors.missed/samples"),
          .coarse_noise = random_key(seed, "encoder.coarse_errors.noise/samples"),
          .coarse_missed = random_key(seed, "encoder.coarse_errors.missed/samples"),
          .dac_noise = random_key(seed, "dac.noise/samples")};
}

// What is the same in all trials.
void set_common_parameters(const Study& study, StudyPlan& plan) {
  plan.common.randomness = trial_randomness(study.seed);
  plan.common.command.targets.resize(plan.open_loop ? 0 : static_cast<std::size_t>(study.moves));
  plan.common.command.torque.levels.resize(plan.open_loop ? plan.list.count : 0);
  for (const Value& value : plan.base) plan.numbers.push_back(value.number);
  const std::set<std::size_t> inputs(plan.input_slots.begin(), plan.input_slots.end());
  for (const std::size_t slot : slots_in_table_order(plan.list)) {
    if (!exists_on(parameter_table()[row_of_slot(slot, plan.list)], plan.units.axis)) continue;
    if (inputs.count(slot) == 0) set_number(plan, slot, plan.numbers[slot], plan.common);
  }
}

std::string column_meaning(const Parameter& parameter, const StudyUnits& units) {
  std::string meaning = meaning_of(parameter, units);
  for (std::size_t i = 0; i < parameter.labels.size(); ++i) {
    meaning += fmt::format("{}{} {}", i == 0 ? " (" : ", ", i, parameter.labels[i]);
  }
  return parameter.labels.empty() ? meaning : meaning + ")";
}

// How often the value of the slot is drawn, of different points the most often.
Per max_frequent_draw(const StudyPlan& plan, std::size_t slot) {
  Per per = Per::study;
  visit_points(plan, {&slot, 1}, [&](std::size_t point) {
    const Value& value = *value_at_point(plan, slot, point);
    switch (value.kind) {
      case Value::Kind::number:
        break;
      case Value::Kind::distribution:
        per = std::max(per, value.per);
        break;
      case Value::Kind::profile:  // where the trial starts
        per = std::max(per, Per::trial);
        break;
    }
    return true;
  });
  return per;
}

// The mean of the slot's profile, if it is drawn at some design point: how often.
std::optional<Per> drawn_mean(const StudyPlan& plan, std::size_t slot) {
  std::optional<Per> per;
  visit_points(plan, {&slot, 1}, [&](std::size_t point) {
    const Value& value = *value_at_point(plan, slot, point);
    if (value.kind == Value::Kind::profile && plan.profiles[value.index]->has_drawn_mean()) {
      per = std::max(per.value_or(value.per), value.per);
    }
    return true;
  });
  return per;
}

void add_column(const InputColumn& column, const InputSource& source, bool swept, StudyPlan& plan,
                Study& study) {
  study.input_columns.push_back(column);
  plan.inputs.push_back(source);
  if (column.per != Per::rig || swept) return;
  study.rig_columns.push_back(column);
  plan.rig_inputs.push_back(source);
}

void list_input_columns(const std::vector<bool>& swept, StudyPlan& plan, Study& study) {
  for (const std::size_t slot : slots_in_table_order(plan.list)) {
    if (plan.base[slot].kind == Value::Kind::number && !swept[slot]) continue;
    const auto number = static_cast<std::uint32_t>(slot);
    const Parameter& parameter = parameter_table()[row_of_slot(slot, plan.list)];
    const std::string name = slot_name(slot, plan.list);
    const std::string unit = unit_of(parameter, plan.units);
    plan.input_slots.push_back(number);
    add_column({name, unit, column_meaning(parameter, plan.units), max_frequent_draw(plan, slot)},
               {number, false}, swept[slot], plan, study);
    if (const auto per = drawn_mean(plan, slot)) {
      add_column({profile_mean_name(name), unit, fmt::format("mean of the profile of {}", name), *per},
                 {number, true}, swept[slot], plan, study);
    }
  }
}

// The profiles of one row that some of the points uses, each with the first point that does.
std::map<std::uint32_t, std::size_t> profiles_in_use(const StudyPlan& plan, std::size_t row,
                                                     std::size_t points) {
  std::map<std::uint32_t, std::size_t> first_point;
  for (std::size_t point = 0; point < points; ++point) {
    const Value& value = *value_at_point(plan, row, point);
    if (value.kind == Value::Kind::profile) first_point.emplace(value.index, point);
  }
  return first_point;
}

void list_profiles(const std::vector<ProfileRequest>& requests, const std::vector<bool>& swept,
                   const StudyPlan& plan, Study& study) {
  const auto table = parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const bool asked =
        std::any_of(requests.begin(), requests.end(), [&](const auto& r) { return r.row == row; });
    if (!asked) continue;
    const auto used = profiles_in_use(plan, row, swept[row] ? study.point_labels.size() : 1);
    for (const auto& [index, point] : used) {
      const std::string suffix = used.size() > 1 ? fmt::format("@{}", point) : "";
      const std::shared_ptr<const Rotors> rotors = plan.profiles[index];
      RealisedProfile profile{std::string(table[row].name) + suffix, unit_of(table[row], plan.units),
                              rotors->rotor(0)};
      if (requests[index].per == Per::rig) {
        profile.of_rig = [rotors](std::int64_t rig) { return rotors->rotor(rig); };
      }
      study.profiles.push_back(std::move(profile));
    }
  }
}

DrawnMean mean_of(const ProfileRequest& request, const Study& study) {
  const Parameter& parameter = parameter_table()[request.row];
  DrawnMean mean{*request.form.mean, study.design, {}};
  mean.randomness.key = random_key(study.seed, profile_mean_name(parameter.name));
  if (study.design == Design::sobol) {
    const std::size_t dimension = first_sobol_dimension_of_means + parameter.sobol_dimension;
    mean.randomness.directions = sobol_directions({&dimension, 1}).front();
  }
  return mean;
}

}  // namespace

void realise_profiles(const std::vector<ProfileRequest>& requests, const Study& study, StudyPlan& plan) {
  for (const ProfileRequest& request : requests) {
    const std::string_view name = parameter_table()[request.row].name;
    std::optional<DrawnMean> mean;
    if (request.form.mean) mean = mean_of(request, study);
    const std::int64_t count = request.per == Per::rig ? std::max<std::int64_t>(study.rigs, 1) : 1;
    plan.profiles.push_back(
        std::make_shared<const Rotors>(request.form.description, std::move(mean), study.seed, name, count));
  }
}

void assemble_study(const std::vector<ProfileRequest>& requests, const std::vector<SweptAxis>& axes,
                    StudyPlan& plan, Study& study) {
  const auto listed = static_cast<std::int64_t>(plan.list.count);
  if (plan.sequence) study.sequence = sequence_moves(*plan.sequence, listed);
  study.units = plan.units;
  study.period = plan.period.value_or(study.period);
  study.moves = plan.sequence ? std::ssize(study.sequence) : listed;
  study.open_loop = plan.open_loop;
  study.point_labels = label_points(axes);
  study.axes = describe_axes(axes, plan);
  study.trace_extras = find_trace_extras(plan);
  study.outcome_extras = find_outcome_extras(plan);
  study.loop_extras = find_loop_extras(plan);
  const std::vector<bool> swept = swept_slots(plan);
  list_input_columns(swept, plan, study);
  derive_randomness(study, plan);
  number_factors(plan, study);
  set_common_parameters(study, plan);
  list_profiles(requests, swept, plan, study);
}

}  // namespace zerocount
