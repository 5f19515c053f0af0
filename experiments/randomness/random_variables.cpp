#include "experiments/randomness/random_variables.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::randomness {
namespace {

/// The distribution at the point of the value that a random coordinate draws; empty if the value is not drawn
/// there.
std::optional<distributions::Distribution> distribution_of(const study::StudyPlan& plan,
                                                           const std::vector<const study::Value*>& values,
                                                           const RandomCoordinate& coordinate) {
  const study::Value& value = *values[coordinate.slots[0]];
  switch (coordinate.kind) {
    case RandomCoordinate::Kind::values:
      if (coordinate.rows > 0) return distributions::Integers{0, coordinate.rows - 1};
      if (value.kind != study::Value::Kind::distribution) return std::nullopt;
      return plan.distributions[value.index];
    case RandomCoordinate::Kind::profile_mean:
      return plan.profiles[value.index]->drawn_mean()->distribution;
    case RandomCoordinate::Kind::profile_at_start:
      break;
  }
  return distributions::Normal{0.0, 1.0};
}

std::string unit_of(const study::Study& study, const RandomCoordinate& coordinate) {
  if (coordinate.rows > 0 || coordinate.kind == RandomCoordinate::Kind::profile_at_start) return "1";
  return std::string(study.plan->table.rows[coordinate.slots[0]].unit);
}

/// Index of a variable among the correlated values (the members of the Gaussian copula); empty if no
/// correlation applies to it.
std::optional<std::size_t> member_of(const study::GaussianCopula& copula, const RandomVariable& variable) {
  if (variable.coordinate.kind != RandomCoordinate::Kind::values || variable.coordinate.rows > 0)
    return std::nullopt;
  const auto place = std::ranges::find(copula.slots, variable.coordinate.slots[0]);
  if (place == copula.slots.end()) return std::nullopt;
  return static_cast<std::size_t>(place - copula.slots.begin());
}

/// Correlation (L·Lᵀ)(row, column) of the normal scores of two members of the Gaussian copula.
double correlation_of(const study::GaussianCopula& copula, std::size_t row, std::size_t column) {
  double sum = 0.0;
  for (std::size_t j = 0; j <= std::min(row, column); ++j)
    sum += copula.factor[row][j] * copula.factor[column][j];
  return sum;
}

study::SquareMatrix correlations_of(const std::optional<study::GaussianCopula>& copula,
                                    const std::vector<RandomVariable>& variables) {
  study::SquareMatrix matrix(variables.size(), std::vector<double>(variables.size(), 0.0));
  for (std::size_t i = 0; i < variables.size(); ++i) {
    matrix[i][i] = 1.0;
    if (!copula) continue;
    const std::optional<std::size_t> member = member_of(*copula, variables[i]);
    for (std::size_t j = 0; j < i && member; ++j) {
      const std::optional<std::size_t> other = member_of(*copula, variables[j]);
      if (other) matrix[i][j] = matrix[j][i] = correlation_of(*copula, *member, *other);
    }
  }
  return matrix;
}

}  // namespace

RandomVariables random_variables(const study::Study& study, std::int64_t point) {
  const std::vector<const study::Value*> values =
      study::values_at(*study.plan, study::plan_point(*study.plan, point));
  RandomVariables result;
  for (RandomCoordinate& coordinate : random_coordinates(study, point)) {
    const auto distribution = distribution_of(*study.plan, values, coordinate);
    if (!distribution) continue;
    const std::string unit = unit_of(study, coordinate);
    const std::string name = coordinate.name;
    result.variables.push_back({name, unit, *distribution, std::move(coordinate)});
  }
  result.correlations = correlations_of(study.plan->copula, result.variables);
  return result;
}

study::GivenDraws draws_with(const study::Study& study, const RandomVariables& variables,
                             std::span<const double> x, std::int64_t number) {
  study::GivenDraws draws{.number = number, .rotor = number};
  if (study.worlds > 0) draws.world = number % study.worlds;
  for (std::size_t i = 0; i < variables.variables.size(); ++i) {
    const RandomVariable& variable = variables.variables[i];
    const std::optional<double> u = distributions::uniform_of(variable.distribution, x[i]);
    if (!u) {
      throw Failure(ExitCode::bad_input,
                    fmt::format("{} = {} cannot be drawn from its distribution in the manifest of '{}'",
                                variable.name, x[i], study.name));
    }
    give(draws, variable.coordinate, *u, x[i]);
  }
  return draws;
}

}  // namespace zerocount::randomness
