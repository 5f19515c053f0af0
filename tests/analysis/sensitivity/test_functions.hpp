#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/sensitivity/sobol_indices.hpp"

/// Functions whose Sobol' indices are known, and saltelli designs of studies that they are computed on.
namespace zerocount::testing {

using UnitFunction = std::function<double(std::span<const double>)>;  ///< of numbers in (0, 1)

/// sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁, x = π(2u − 1) (Ishigami & Homma 1990). Not of u₄ …
double ishigami(std::span<const double> u);
std::vector<double> ishigami_first_orders();  ///< of u₁, u₂, u₃
std::vector<double> ishigami_totals();

/// Π (|4u_j − 2| + a_j)/(1 + a_j) with a = 0, 1, 4.5, 9, 99, of as many u as there are (Sobol' 1993).
double g_function(std::span<const double> u);
std::vector<double> g_first_orders(std::size_t factors);
std::vector<double> g_totals(std::size_t factors);

/// The uniform numbers of the trials of a study with up to five factors, [trial][factor].
std::vector<std::vector<double>> drawn_points(const std::string& design, std::size_t factors,
                                              std::size_t trials, std::uint64_t seed);

/// The function at the points of a saltelli design.
sensitivity::SaltelliSample sample_of(const UnitFunction& function,
                                      const std::vector<std::vector<double>>& points);

}  // namespace zerocount::testing
