#include "experiments/randomness/random_coordinates.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <variant>

#include <fmt/format.h>

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

namespace {

double score_of(const DiscreteDraw& draw, std::span<const double> z) {
  double score = 0.0;
  for (const auto& [coordinate, factor] : draw.direction) score += factor * z[coordinate];
  return score;
}

/// The pairs (coordinate, factor) of DiscreteDraw::direction for a coordinate. For a correlated coordinate
/// the factors are its row of the Cholesky factor L.
std::vector<std::pair<std::size_t, double>> direction_of(const study::Study& study,
                                                         std::span<const RandomCoordinate> coordinates,
                                                         std::size_t coordinate) {
  const std::optional<study::GaussianCopula>& copula = study.plan->copula;
  const std::uint32_t slot = coordinates[coordinate].slots[0];
  if (!copula || coordinates[coordinate].rows > 0) return {{coordinate, 1.0}};
  const auto member = std::ranges::find(copula->slots, slot);
  if (member == copula->slots.end()) return {{coordinate, 1.0}};
  const std::vector<double>& factors =
      copula->factor[static_cast<std::size_t>(member - copula->slots.begin())];
  std::vector<std::pair<std::size_t, double>> direction;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto other = std::ranges::find(copula->slots, coordinates[i].slots[0]);
    if (coordinates[i].kind != RandomCoordinate::Kind::values || other == copula->slots.end()) continue;
    const double factor = factors[static_cast<std::size_t>(other - copula->slots.begin())];
    if (factor != 0.0) direction.emplace_back(i, factor);
  }
  return direction;
}

DiscreteDraw draw_of(const distributions::Choice& choice) {
  DiscreteDraw draw{.rows = std::ssize(choice.values)};
  draw.ordered =
      std::ranges::is_sorted(choice.values) || std::ranges::is_sorted(choice.values, std::greater<>());
  std::map<double, std::uint32_t> number_of;
  for (const double value : choice.values) {
    const auto [at, is_new] = number_of.emplace(value, static_cast<std::uint32_t>(draw.numbers.size()));
    if (is_new) draw.numbers.push_back(value);
    draw.values_of_rows.push_back(at->second);
  }
  return draw;
}

/// The discrete draw of a distribution; empty if the distribution is continuous.
std::optional<DiscreteDraw> draw_of(const distributions::Distribution& distribution) {
  if (const auto* choice = std::get_if<distributions::Choice>(&distribution)) return draw_of(*choice);
  if (const auto* integers = std::get_if<distributions::Integers>(&distribution))
    return DiscreteDraw{.rows = integers->high - integers->low + 1, .ordered = true, .first = integers->low};
  return std::nullopt;
}

}  // namespace

std::vector<DiscreteDraw> discrete_draws(const study::Study& study, std::int64_t point,
                                         std::span<const RandomCoordinate> coordinates) {
  const study::StudyPlan& plan = *study.plan;
  std::vector<DiscreteDraw> draws;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const RandomCoordinate& coordinate = coordinates[i];
    if (coordinate.kind != RandomCoordinate::Kind::values) continue;
    const study::Value& value =
        *study::value_at_point(plan, coordinate.slots[0], study::plan_point(plan, point));
    std::optional<DiscreteDraw> draw;
    if (coordinate.rows > 0) {
      draw = DiscreteDraw{.rows = coordinate.rows};
    } else if (value.kind == study::Value::Kind::distribution) {
      draw = draw_of(plan.distributions[value.index]);
    }
    if (!draw || draw->values() < 2) continue;
    draw->name = coordinate.name;
    draw->direction = direction_of(study, coordinates, i);
    draws.push_back(*std::move(draw));
  }
  return draws;
}

std::int64_t value_of_row(const DiscreteDraw& draw, std::int64_t row) {
  return draw.values_of_rows.empty() ? row : draw.values_of_rows[static_cast<std::size_t>(row)];
}

std::int64_t value_at(const DiscreteDraw& draw, std::span<const double> z) {
  const double place = static_cast<double>(draw.rows) * uniform_of_score(score_of(draw, z));
  return value_of_row(draw, std::min(static_cast<std::int64_t>(place), draw.rows - 1));
}

void move_to_row(const DiscreteDraw& draw, std::int64_t row, double uniform, std::span<double> z) {
  const double u = (static_cast<double>(row) + uniform) / static_cast<double>(draw.rows);
  const double moved = numerics::normal_quantile(std::clamp(u, 0x1p-53, 1.0 - 0x1p-53)) - score_of(draw, z);
  for (const auto& [coordinate, factor] : draw.direction) z[coordinate] += factor * moved;
}

std::string value_text(const DiscreteDraw& draw, std::int64_t value) {
  if (!draw.numbers.empty()) return fmt::format("{:.6g}", draw.numbers[static_cast<std::size_t>(value)]);
  return draw.ordered ? fmt::format("{}", draw.first + value) : fmt::format("row {}", value);
}

}  // namespace zerocount::randomness
