#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/sensitivity/sobol_indices.hpp"

/// Functions with known Sobol' indices, and the saltelli designs at which they are evaluated.
namespace zerocount::testing {

using UnitFunction = std::function<double(std::span<const double>)>;  ///< function of uniform numbers

/// sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁, x = π(2u − 1) (Ishigami & Homma 1990). Ignores u₄ and following.
double ishigami(std::span<const double> u);
std::vector<double> ishigami_first_orders();  ///< first-order indices of u₁, u₂, u₃
std::vector<double> ishigami_totals();

/// Π (|4u_j − 2| + a_j)/(1 + a_j) with a = 0, 1, 4.5, 9, 99, over the given u (Sobol' 1993).
double g_function(std::span<const double> u);
std::vector<double> g_first_orders(std::size_t factors);
std::vector<double> g_totals(std::size_t factors);

/// The uniform numbers of the trials of a study with up to five factors, [trial][factor].
std::vector<std::vector<double>> drawn_points(const std::string& design, std::size_t factors,
                                              std::size_t trials, std::uint64_t seed);

/// Values of the function at the points of a saltelli design.
sensitivity::SaltelliSample sample_of(const UnitFunction& function,
                                      const std::vector<std::vector<double>>& points);

}  // namespace zerocount::testing
