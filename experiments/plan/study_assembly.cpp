#include "experiments/plan/study_assembly.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "experiments/designs/random_key.hpp"
#include "experiments/language/factors.hpp"
#include "experiments/language/loop_extras.hpp"
#include "experiments/language/outcome_extras.hpp"
#include "experiments/language/slots.hpp"
#include "experiments/language/trace_extras.hpp"

namespace zerocount {
namespace {

// Which slots some axis assigns.
std::vector<bool> swept_slots(const StudyPlan& plan) {
  std::vector<bool> swept(plan.base.size(), false);
  for (const PlanAxis& axis : plan.axes) {
    for (const Assignment& assignment : axis.assignments) swept[assignment.slot] = true;
  }
  return swept;
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
    plan.randomness[slot] = {random_key(study.seed, slot_name(slot, plan.list)), directions[i]};
  }
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
  for (std::size_t i = 0; i < parameter.words.size(); ++i) {
    meaning += fmt::format("{}{} {}", i == 0 ? " (" : ", ", i, parameter.words[i]);
  }
  return parameter.words.empty() ? meaning : meaning + ")";
}

void list_input_columns(const std::vector<bool>& swept, StudyPlan& plan, Study& study) {
  for (const std::size_t slot : slots_in_table_order(plan.list)) {
    if (plan.base[slot].kind == Value::Kind::number && !swept[slot]) continue;
    const Parameter& parameter = parameter_table()[row_of_slot(slot, plan.list)];
    study.input_columns.push_back(
        {slot_name(slot, plan.list), unit_of(parameter, plan.units), column_meaning(parameter, plan.units)});
    plan.input_slots.push_back(static_cast<std::uint32_t>(slot));
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
      study.profiles.push_back(
          {std::string(table[row].name) + suffix, unit_of(table[row], plan.units), plan.profiles[index]});
    }
  }
}

}  // namespace

void realise_profiles(const std::vector<ProfileRequest>& requests, std::uint64_t seed, StudyPlan& plan) {
  for (const ProfileRequest& request : requests) {
    plan.profiles.push_back(std::make_shared<const Profile>(
        realise_profile(request.description, seed, parameter_table()[request.row].name)));
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
