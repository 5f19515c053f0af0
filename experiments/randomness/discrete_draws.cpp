#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <variant>

#include <fmt/format.h>

#include "core/numerics/normal_distribution.hpp"
#include "experiments/randomness/random_coordinates.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::randomness {
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
