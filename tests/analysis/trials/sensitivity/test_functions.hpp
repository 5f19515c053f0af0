#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/trials/sensitivity/sobol_indices.hpp"

/// Functions with known Sobol' indices, and the saltelli designs at which they are evaluated.
namespace zerocount::testing {

/// Function of uniform numbers in (0, 1), one for each factor.
using UnitFunction = std::function<double(std::span<const double>)>;

/// The function of Ishigami & Homma (1990): sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁, x = π(2u − 1). Ignores u₄
/// and following.
double ishigami(std::span<const double> u);
/// First-order Sobol' indices of the factors u₁, u₂, u₃ of ishigami().
std::vector<double> ishigami_first_orders();
std::vector<double> ishigami_totals();

/// Sobol's g-function (1993): Π (|4u_j − 2| + a_j)/(1 + a_j) with a = 0, 1, 4.5, 9, 99, over the given u.
double g_function(std::span<const double> u);
std::vector<double> g_first_orders(std::size_t factors);
std::vector<double> g_totals(std::size_t factors);

/// [trial][factor] the uniform numbers that the trials of a study with this design draw; up to five factors.
std::vector<std::vector<double>> drawn_points(const std::string& design, std::size_t factors,
                                              std::size_t trials, std::uint64_t seed);

/// The values of the function at the points of a saltelli design, arranged for the estimation of Sobol'
/// indices.
/// @param points [trial][factor] uniform numbers
sensitivity::SaltelliSample sample_of(const UnitFunction& function,
                                      const std::vector<std::vector<double>>& points);

}  // namespace zerocount::testing
