#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/randomness/random_coordinates.hpp"

/// Probability of a rare failure. A trial is a function of independent standard normal coordinates, and of
/// further random numbers that follow from its number.
namespace zerocount::rare {

using random::NumberSource;

/// One normal distribution of a mixture, of d coordinates.
struct NormalComponent {
  double weight{1.0};
  std::vector<double> mean;  ///< [d] Mean.
  /// [d·d] L by rows, the lower triangular factor of the covariance L·Lᵀ.
  std::vector<double> factor;
  std::vector<double> inverse_factor;  ///< [d·d] L⁻¹ by rows.
  double log_determinant{0.0};         ///< ln det L
};

/// Component with its inverse factor and determinant.
/// @param factor L by rows, the lower triangular factor of the covariance L·Lᵀ
NormalComponent normal_component(double weight, std::vector<double> mean, std::vector<double> factor);

/// Density of a mixture divided by the standard normal density φ: Σ_c weight_c·N_c(z)/φ(z). The weights sum
/// to 1.
/// @param z [d]
double density_ratio(std::span<const NormalComponent> components, std::span<const double> z);

/// Draws a point [d] from a component: mean + L·ξ, with ξ standard normal.
std::vector<double> draw(const NormalComponent& component, NumberSource& numbers);

/// Points to which a mixture is fitted.
struct WeightedPoints {
  std::vector<std::vector<double>> z;  ///< [point][coordinate]
  std::vector<double> weights;         ///< [point] Weights, not negative.

  void add(std::vector<double> point, double weight) {
    z.push_back(std::move(point));
    weights.push_back(weight);
  }
};

/// Effective sample size of weighted points: (Σw)²/Σw².
double effective_size(std::span<const double> weights);

/// Fits a mixture of normal distributions to weighted points.
///
///     for k = 1 … 8 components, while the Bayesian information criterion decreases:
///       alternate expectation and maximisation until the likelihood stands still
///
/// Each covariance S is widened for use in a proposal. First a fraction of the unit matrix is added, as if d
/// + 2 points of the trials' own distribution were among the points; then 1.25·S·(I + S)⁻³ is added. In
/// directions that failure narrows, the variance grows up to 2.25 times, because the density of failures
/// falls like an exponential there, slower than a normal density. In other directions it grows by a sixth or
/// less. Source: Geyer, Papaioannou and Straub, Cross entropy-based importance sampling using Gaussian
/// densities revisited, Structural Safety 76 (2019).
/// @param points at least one with a positive weight
std::vector<NormalComponent> fitted_mixture(const WeightedPoints& points, NumberSource& numbers);

/// fitted_mixture() with a single component.
NormalComponent fitted_normal(const WeightedPoints& points, NumberSource& numbers);

/// A trial: its random coordinates and number, and its result.
struct Trial {
  std::vector<double> z;   ///< [coordinate] Standard normal coordinates.
  std::int64_t number{0};  ///< Number from which all other random numbers of the trial follow.
  double failed{0.0};      ///< Proportion of the trial's moves that fail.
  /// [score] Largest score of the trial's moves; NaN: not known. Scores are continuous. A useful score is
  /// larger the closer a move is to failure.
  std::vector<double> scores{};
  double weight{1.0};  ///< likelihood_ratio() of a trial that was drawn from a proposal.
};

/// Function that runs trials and sets their `failed` and `scores`.
using Simulation = std::function<void(std::span<Trial>)>;

/// Independent standard normal coordinates of a trial, and the discrete draws that depend on them.
struct TrialSpace {
  std::size_t coordinates{0};
  std::vector<randomness::DiscreteDraw> discrete{};
  /// Indices of the coordinates in which nearby points have nothing in common, ascending. They belong to
  /// discrete draws that are neither ordered nor correlated.
  std::vector<std::size_t> unordered{};
};

TrialSpace trial_space(std::size_t coordinates, std::vector<randomness::DiscreteDraw> discrete);

/// Condition that one discrete draw has one value. All else keeps its own distribution.
struct PinnedValue {
  std::size_t draw{0};  ///< Index in TrialSpace::discrete.
  std::int64_t value{0};
  double probability{1.0};           ///< Probability of the value.
  double weight{1.0};                ///< Weight in a proposal; the weights of its pinned values sum to 1.
  std::int64_t failures{0};          ///< Number of failures among `trials`.
  std::int64_t trials{0};            ///< Number of trials at this value by which it was chosen.
  std::vector<std::int64_t> rows{};  ///< Rows of a table of samples that the value represents.
};

/// All values of a discrete draw.
std::vector<PinnedValue> pinned_values(const TrialSpace& space, std::size_t draw);

/// Distribution from which trials are drawn instead of their own, with the density
///
///     q(z) = natural·φ(z) + (1 − natural)·(pinned·Σ_v weight_v·φ(z | value v) + (1 − pinned)·Σ_c
///     weight_c·N_c(z))
///
/// where φ is the standard normal density and N_c are the normal components. The components describe the
/// coordinates that are not unordered; unordered coordinates keep φ.
struct Proposal {
  double natural{1.0};  ///< Proportion of draws from the trials' own distribution.
  double pinned{0.0};   ///< Proportion of the pinned values among the other draws.
  std::vector<PinnedValue> values{};
  std::vector<NormalComponent> components{};

  /// Whether all trials are drawn from their own distribution.
  bool is_natural() const { return values.empty() && components.empty(); }
};

/// Coordinates of a point that the normal components describe: all but the unordered ones, in their order.
std::vector<double> proposal_coordinates(const TrialSpace& space, std::span<const double> z);

/// Whether the point has one of the pinned values.
bool is_pinned(const TrialSpace& space, const Proposal& proposal, std::span<const double> z);

/// Likelihood ratio at a point: density of the trials' own distribution divided by the proposal's density. It
/// is at most 1/natural.
double likelihood_ratio(const TrialSpace& space, const Proposal& proposal, std::span<const double> z);

/// Largest likelihood ratio of a point with a pinned value; 0 without pinned values.
double max_ratio_of_pinned(const Proposal& proposal);

/// A point drawn from a proposal.
struct DrawnPoint {
  std::vector<double> z;
  bool natural{false};  ///< Whether the point was drawn from the trials' own distribution.
};

DrawnPoint draw(const TrialSpace& space, const Proposal& proposal, NumberSource& numbers);

/// Draws a point from the trials' own distribution, given the pinned value.
std::vector<double> draw_pinned(const TrialSpace& space, const PinnedValue& pinned, NumberSource& numbers);

}  // namespace zerocount::rare
