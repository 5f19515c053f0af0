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

/// One normal distribution of a mixture, over d coordinates.
struct NormalComponent {
  double weight{1.0};
  std::vector<double> mean;  ///< [d] Mean, one value per coordinate.
  /// [d·d] L by rows, the lower triangular factor of the covariance L·Lᵀ.
  std::vector<double> factor;
  std::vector<double> inverse_factor;  ///< [d·d] Inverse L⁻¹ of `factor`, by rows.
  double log_determinant{0.0};         ///< ln det L, natural logarithm of the determinant of `factor`.
};

/// Makes a normal component, and computes its inverse factor and determinant.
/// @param factor L by rows, the lower triangular factor of the covariance L·Lᵀ
NormalComponent normal_component(double weight, std::vector<double> mean, std::vector<double> factor);

/// Density of a mixture of normal distributions divided by the standard normal density φ at the same point:
/// Σ_c weight_c·N_c(z)/φ(z). The weights sum to 1.
/// @param z point, [d]
double density_ratio(std::span<const NormalComponent> components, std::span<const double> z);

/// Draws a point [d] from a component: mean + L·ξ, with ξ standard normal.
std::vector<double> draw(const NormalComponent& component, NumberSource& numbers);

/// Points to which a mixture of normal distributions is fitted, each with a weight.
struct WeightedPoints {
  std::vector<std::vector<double>> z;  ///< [point][coordinate] Standard normal coordinates.
  std::vector<double> weights;         ///< [point] Weight of each point, 0 or positive.

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

/// Fits a single normal distribution to weighted points, and widens it as fitted_mixture() does.
NormalComponent fitted_normal(const WeightedPoints& points, NumberSource& numbers);

/// A simulated trial as a function of random coordinates: the standard normal coordinates, the number that
/// gives all other random numbers, and the result.
struct Trial {
  /// [coordinate] Independent standard normal coordinates, from which the trial's random values follow.
  std::vector<double> z;
  std::int64_t number{0};  ///< Number from which all other random numbers of the trial follow.
  double failed{0.0};      ///< Proportion of the trial's judged moves that fail, 0 to 1.
  /// [score] Largest score of the trial's moves; NaN: not known. A score is a continuous measure of a move. A
  /// useful one is larger the closer the move is to failure.
  std::vector<double> scores{};
  /// likelihood_ratio() at the trial's point if it was drawn from a proposal; 1 if it was drawn from its own
  /// distribution.
  double weight{1.0};
};

/// Function that simulates trials, given their `z` and `number`, and sets their `failed` and `scores`.
using Simulation = std::function<void(std::span<Trial>)>;

/// Space in which each trial is a point: the number of its standard normal coordinates, and the discrete
/// draws that these coordinates decide.
struct TrialSpace {
  std::size_t coordinates{0};
  std::vector<randomness::DiscreteDraw> discrete{};
  /// Indices of the coordinates in which nearby points have nothing in common, ascending. These coordinates
  /// belong to discrete draws whose values have no order and no correlation.
  std::vector<std::size_t> unordered{};
};

TrialSpace trial_space(std::size_t coordinates, std::vector<randomness::DiscreteDraw> discrete);

/// Condition that one discrete draw, such as the choice of a table row, has one value. All other draws keep
/// their own distribution.
struct PinnedValue {
  std::size_t draw{0};  ///< Index of the discrete draw in TrialSpace::discrete.
  std::int64_t value{0};
  double probability{1.0};  ///< Probability that the discrete draw has this value.
  /// Weight of this value in a proposal. The weights of all pinned values of a proposal sum to 1.
  double weight{1.0};
  std::int64_t failures{0};  ///< Number of failed trials among `trials`.
  std::int64_t trials{0};    ///< Number of trials run at this value. Their failures are why it was pinned.
  /// Rows of a table of samples that this value of the draw represents, counted from 0.
  std::vector<std::int64_t> rows{};
};

/// All possible values of a discrete draw, each as a PinnedValue with its probability.
/// @param draw index in TrialSpace::discrete
std::vector<PinnedValue> pinned_values(const TrialSpace& space, std::size_t draw);

/// Distribution from which trials are drawn instead of their own, with the density
///
///     q(z) = natural·φ(z) + (1 − natural)·(pinned·Σ_v weight_v·φ(z | value v) + (1 − pinned)·Σ_c
///     weight_c·N_c(z))
///
/// where φ is the standard normal density and N_c are the normal components. The components describe the
/// coordinates that are not unordered; unordered coordinates keep φ.
struct Proposal {
  double natural{1.0};  ///< Proportion of draws from the trials' own distribution, 0 to 1.
  /// Proportion of the draws from pinned values among the draws that are not `natural`, 0 to 1.
  double pinned{0.0};
  std::vector<PinnedValue> values{};
  std::vector<NormalComponent> components{};

  /// Whether all trials are drawn from their own distribution, so that nothing was learned.
  bool is_natural() const { return values.empty() && components.empty(); }
};

/// Coordinates of a point that the normal components describe: all but TrialSpace::unordered, in ascending
/// order of their indices.
std::vector<double> proposal_coordinates(const TrialSpace& space, std::span<const double> z);

/// Whether some discrete draw has a pinned value of the proposal at this point.
bool is_pinned(const TrialSpace& space, const Proposal& proposal, std::span<const double> z);

/// Likelihood ratio at a point: density of the trials' own distribution divided by the proposal's density. It
/// is at most 1/natural.
double likelihood_ratio(const TrialSpace& space, const Proposal& proposal, std::span<const double> z);

/// Upper limit of likelihood_ratio() over points with a pinned value; 0 without pinned values.
double max_ratio_of_pinned(const Proposal& proposal);

/// A point of standard normal coordinates drawn from a proposal.
struct DrawnPoint {
  std::vector<double> z;
  bool natural{false};  ///< Whether the point was drawn from the trials' own distribution.
};

DrawnPoint draw(const TrialSpace& space, const Proposal& proposal, NumberSource& numbers);

/// Draws a point from the trials' own distribution, under the condition that the discrete draw has the pinned
/// value.
std::vector<double> draw_pinned(const TrialSpace& space, const PinnedValue& pinned, NumberSource& numbers);

}  // namespace zerocount::rare
