#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/random/number_source.hpp"

namespace zerocount::rare {

using random::NumberSource;

/// One normal distribution of a mixture, of d coordinates.
struct NormalComponent {
  double weight{1.0};
  std::vector<double> mean;            ///< [d]
  std::vector<double> factor;          ///< [d·d], by rows: L of the covariance L·Lᵀ, lower triangular
  std::vector<double> inverse_factor;  ///< [d·d], by rows: L⁻¹
  double log_determinant{0.0};         ///< ln det L
};

/// @param factor L of its covariance, by rows
NormalComponent normal_component(double weight, std::vector<double> mean, std::vector<double> factor);

/// Σ_c weight_c·N_c(z)/φ(z): density of a mixture, whose weights sum to 1, over the standard normal one.
/// @param z [d]
double density_ratio(std::span<const NormalComponent> components, std::span<const double> z);

/// A draw from the component, mean + L·ξ: [d].
std::vector<double> draw(const NormalComponent& component, NumberSource& numbers);

/// Points to which a mixture is fitted.
struct WeightedPoints {
  std::vector<std::vector<double>> z;
  std::vector<double> weights;  ///< not negative

  void add(std::vector<double> point, double weight) {
    z.push_back(std::move(point));
    weights.push_back(weight);
  }
};

/// Number of equally weighted points that tell as much: (Σw)²/Σw².
double effective_size(std::span<const double> weights);

/// A mixture of normal distributions fitted to weighted points.
///
///     for k = 1 … 8 components, while the Bayesian information criterion decreases:
///       alternate expectation and maximisation until the likelihood stands still
///
/// A covariance S becomes that of a proposal: a part of the unit
/// matrix is added as if d + 2 points of the trials' own distribution were among the points; then
/// 1.25·S·(I + S)⁻³ is added. Directions that failure narrows get up to 2.25 times their variance, because
/// its density falls there like an exponential, slower than a normal one; that of others grows by a sixth or
/// less. Source: Geyer, Papaioannou and Straub, Cross entropy-based importance sampling using Gaussian
/// densities revisited, Structural Safety 76 (2019).
/// @param points at least one with a positive weight
std::vector<NormalComponent> fitted_mixture(const WeightedPoints& points, NumberSource& numbers);

/// fitted_mixture() with a single component.
NormalComponent fitted_normal(const WeightedPoints& points, NumberSource& numbers);

}  // namespace zerocount::rare
