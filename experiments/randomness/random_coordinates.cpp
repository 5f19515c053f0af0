#include "experiments/randomness/random_coordinates.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "core/numerics/normal_distribution.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::randomness {
namespace {

using Kind = RandomCoordinate::Kind;

bool is_drawn_for_trials(study::DrawLevel level) {
  switch (level) {
    case study::DrawLevel::machine:
    case study::DrawLevel::trial:
    case study::DrawLevel::contact:
      return true;
    case study::DrawLevel::study:
    case study::DrawLevel::world:
      break;
  }
  return false;
}

bool is_member(const std::vector<std::uint32_t>& slots, std::uint32_t slot) {
  return std::ranges::find(slots, slot) != slots.end();
}

/// Adds the random coordinates of the value of one slot (a parameter in the plan), if the value is drawn per
/// machine, trial or contact.
void add_coordinates(const study::Study& study, std::uint32_t slot, const study::Value& value,
                     std::vector<RandomCoordinate>& coordinates) {
  const std::string name(study.plan->table.rows[slot].name);
  switch (value.kind) {
    case study::Value::Kind::number:
    case study::Value::Kind::derived:
      break;
    case study::Value::Kind::distribution:
      if (is_drawn_for_trials(value.level))
        coordinates.push_back(
            {name, Kind::values, {slot}, 0, study::differs_between_machines(study, value.level, name)});
      break;
    case study::Value::Kind::profile:
      if (value.level != study::DrawLevel::machine) break;
      if (study.plan->profiles[value.index]->drawn_mean())
        coordinates.push_back({name + ".mean", Kind::profile_mean, {slot}, 0, true});
      coordinates.push_back({name, Kind::profile_at_start, {slot}, 0, true});
      break;
  }
}

/// Adds coordinates for correlated parameters (members of the Gaussian copula) that are not drawn at this
/// point. The random numbers of the other members depend on them.
void add_fixed_members(const study::Study& study, const std::vector<const study::Value*>& values,
                       std::vector<RandomCoordinate>& coordinates) {
  const std::optional<study::GaussianCopula>& copula = study.plan->copula;
  if (!copula || !is_drawn_for_trials(copula->level)) return;
  for (const std::uint32_t slot : copula->slots) {
    if (values[slot]->kind == study::Value::Kind::distribution) continue;
    const std::string name(study.plan->table.rows[slot].name);
    coordinates.push_back({name + " (of correlations)",
                           Kind::values,
                           {slot},
                           0,
                           study::differs_between_machines(study, copula->level, name)});
  }
}

}  // namespace

double uniform_of_score(double z) {
  return std::clamp(numerics::normal_probability(z), 0x1p-53, 1.0 - 0x1p-53);
}

void give(study::GivenDraws& draws, const RandomCoordinate& coordinate, double uniform, double score) {
  switch (coordinate.kind) {
    case Kind::values:
      for (const std::uint32_t slot : coordinate.slots) draws.uniforms[slot] = uniform;
      break;
    case Kind::profile_mean:
      draws.profiles[coordinate.slots[0]].mean = uniform;
      break;
    case Kind::profile_at_start:
      draws.profiles[coordinate.slots[0]].field = score;
      break;
  }
}

std::vector<RandomCoordinate> random_coordinates(const study::Study& study, std::int64_t point) {
  const study::StudyPlan& plan = *study.plan;
  const std::vector<const study::Value*> values = study::values_at(plan, study::plan_point(plan, point));
  std::vector<RandomCoordinate> coordinates;
  RandomCoordinate joint;
  joint.rows = study.samples ? study.samples->rows : 0;
  joint.of_machine = true;  // if all of its columns are
  for (const std::uint32_t slot : plan.input_slots) {
    if (!is_member(plan.sampled_slots, slot)) {
      add_coordinates(study, slot, *values[slot], coordinates);
    } else if (is_drawn_for_trials(values[slot]->level)) {
      joint.name += (joint.name.empty() ? "" : ", ") + std::string(plan.table.rows[slot].name);
      joint.of_machine = joint.of_machine && study::differs_between_machines(study, values[slot]->level,
                                                                             plan.table.rows[slot].name);
      joint.slots.push_back(slot);
    }
  }
  if (!joint.slots.empty()) coordinates.push_back(std::move(joint));
  add_fixed_members(study, values, coordinates);
  return coordinates;
}

study::GivenDraws draws_at(const study::Study& study, std::span<const RandomCoordinate> coordinates,
                           std::span<const double> z, std::int64_t number) {
  study::GivenDraws draws{.number = number, .rotor = number};
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    give(draws, coordinates[i], uniform_of_score(z[i]), z[i]);
  const std::optional<study::GaussianCopula>& copula = study.plan->copula;
  if (!copula) return draws;
  const std::map<std::uint32_t, double> independent = draws.uniforms;
  for (std::size_t member = 0; member < copula->slots.size(); ++member) {
    const auto given = draws.uniforms.find(copula->slots[member]);
    if (given == draws.uniforms.end()) continue;
    given->second = study::copula_uniform(*copula, member,
                                          [&](std::size_t j) { return independent.at(copula->slots[j]); });
  }
  return draws;
}

}  // namespace zerocount::randomness
