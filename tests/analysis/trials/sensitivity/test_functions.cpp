#include "tests/analysis/trials/sensitivity/test_functions.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/designs/designs.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::testing {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double a = 7.0;
constexpr double b = 0.1;
constexpr std::array<double, 5> g_parameters{0.0, 1.0, 4.5, 9.0, 99.0};

// Parts of the variance of Ishigami's function: of x₁, of x₂, and of x₁ with x₃.
struct IshigamiParts {
  double first{0.5 * std::pow(1.0 + b * std::pow(pi, 4) / 5.0, 2)};
  double second{a * a / 8.0};
  double first_with_third{b * b * std::pow(pi, 8) * (1.0 / 18.0 - 1.0 / 50.0)};
  double total{first + second + first_with_third};
};

// Part of the variance of a factor of the g-function, over the squared mean.
double g_part(std::size_t factor) {
  return 1.0 / (3.0 * std::pow(1.0 + g_parameters.at(factor), 2));
}

double g_variance(std::size_t factors) {
  double product = 1.0;
  for (std::size_t j = 0; j < factors; ++j) product *= 1.0 + g_part(j);
  return product - 1.0;
}

}  // namespace

double ishigami(std::span<const double> u) {
  const auto x = [&](std::size_t j) { return pi * (2.0 * u[j] - 1.0); };
  return std::sin(x(0)) + a * std::pow(std::sin(x(1)), 2) + b * std::pow(x(2), 4) * std::sin(x(0));
}

std::vector<double> ishigami_first_orders() {
  const IshigamiParts parts;
  return {parts.first / parts.total, parts.second / parts.total, 0.0};
}

std::vector<double> ishigami_totals() {
  const IshigamiParts parts;
  return {(parts.first + parts.first_with_third) / parts.total, parts.second / parts.total,
          parts.first_with_third / parts.total};
}

double g_function(std::span<const double> u) {
  double product = 1.0;
  for (std::size_t j = 0; j < u.size(); ++j)
    product *= (std::abs(4.0 * u[j] - 2.0) + g_parameters.at(j)) / (1.0 + g_parameters.at(j));
  return product;
}

std::vector<double> g_first_orders(std::size_t factors) {
  std::vector<double> indices;
  for (std::size_t j = 0; j < factors; ++j) indices.push_back(g_part(j) / g_variance(factors));
  return indices;
}

std::vector<double> g_totals(std::size_t factors) {
  std::vector<double> indices;
  for (std::size_t j = 0; j < factors; ++j) {
    const double others = (g_variance(factors) + 1.0) / (1.0 + g_part(j));
    indices.push_back(g_part(j) * others / g_variance(factors));
  }
  return indices;
}

std::vector<std::vector<double>> drawn_points(const std::string& design, std::size_t factors,
                                              std::size_t trials, std::uint64_t seed) {
  constexpr std::array<const char*, 5> keys{"k1", "k2", "beta", "alpha", "lambda"};
  std::string friction;
  for (std::size_t j = 0; j < factors; ++j)
    friction += fmt::format("{}{}: {{uniform: [1, 2]}}", j == 0 ? "" : ", ", keys.at(j));
  const study::Study study = manifest::parse_study(
      fmt::format("{{zerocount: 1, name: t, seed: {}, trials: {}, design: {}, command: {{targets: [5]}}, "
                  "friction: {{{}}}}}",
                  seed, trials, design, friction),
      "test");
  std::vector<std::vector<double>> points;
  for (std::int64_t i = 0; i < study.trials; ++i) {
    points.push_back(study::study_trial(study, 0, i).inputs);
    for (double& value : points.back()) value -= 1.0;
  }
  return points;
}

sensitivity::SaltelliSample sample_of(const UnitFunction& function,
                                      const std::vector<std::vector<double>>& points) {
  const std::size_t factors = points.front().size();
  sensitivity::SaltelliSample sample;
  sample.c.resize(factors);
  for (std::size_t start = 0; start < points.size(); start += designs::saltelli_row_length(factors)) {
    sample.a.push_back(function(points[start]));
    sample.b.push_back(function(points[start + 1]));
    for (std::size_t j = 0; j < factors; ++j) sample.c[j].push_back(function(points[start + 2 + j]));
  }
  return sample;
}

}  // namespace zerocount::testing
