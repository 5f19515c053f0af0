#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/randomness/random_coordinates.hpp"

/// The probability of a rare failure. A trial is a function of independent standard normal coordinates, and
/// of further random numbers that follow from its number.
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

/// A trial: the point at which the function is taken, and its result.
struct Trial {
  std::vector<double> z;   ///< [coordinate]
  std::int64_t number{0};  ///< of which all other random numbers of the trial follow
  double failed{0.0};      ///< proportion of its moves that fail
  /// [score] The largest of its moves, continuous; a useful score is larger the nearer a move is to failure.
  /// NaN: not known.
  std::vector<double> scores{};
  double weight{1.0};  ///< likelihood_ratio(), of a trial that was drawn from a proposal
};

/// Runs trials: sets `failed` and `scores`.
using Simulation = std::function<void(std::span<Trial>)>;

/// The independent standard normal coordinates of a trial, and what is drawn from them in discrete steps.
struct TrialSpace {
  std::size_t coordinates{0};
  std::vector<randomness::DiscreteDraw> discrete{};
  /// Coordinates in which near points have nothing in common, in ascending order: those of discrete draws
  /// that are neither ordered nor correlated.
  std::vector<std::size_t> unordered{};
};

TrialSpace trial_space(std::size_t coordinates, std::vector<randomness::DiscreteDraw> discrete);

/// Trials of which one discrete draw has one value; all else has its own distribution.
struct PinnedValue {
  std::size_t draw{0};  ///< of TrialSpace::discrete
  std::int64_t value{0};
  double probability{1.0};           ///< of the value
  double weight{1.0};                ///< among the pinned values of a proposal; they sum to 1
  std::int64_t failures{0};          ///< among the trials at this value by which it was chosen
  std::int64_t trials{0};            ///< number of these trials
  std::vector<std::int64_t> rows{};  ///< of a table of samples that the value stands for
};

/// All values of a discrete draw.
std::vector<PinnedValue> pinned_values(const TrialSpace& space, std::size_t draw);

/// The distribution from which trials are drawn in place of their own, of the density
///
///     q(z) = natural·φ(z) + (1 − natural)·(pinned·Σ_v weight_v·φ(z | value v) + (1 − pinned)·Σ_c
///     weight_c·N_c(z))
///
/// with φ the standard normal density and N_c the normal components, which are of the coordinates that are
/// not unordered; the others keep φ.
struct Proposal {
  double natural{1.0};
  double pinned{0.0};
  std::vector<PinnedValue> values{};
  std::vector<NormalComponent> components{};

  bool is_natural() const { return values.empty() && components.empty(); }
};

/// The coordinates that are drawn from the normal components: all but the unordered ones, in their order.
std::vector<double> proposal_coordinates(const TrialSpace& space, std::span<const double> z);

/// Whether the point has one of the pinned values.
bool is_pinned(const TrialSpace& space, const Proposal& proposal, std::span<const double> z);

/// Density of the trials' own distribution over that of the proposal, at most 1/natural.
double likelihood_ratio(const TrialSpace& space, const Proposal& proposal, std::span<const double> z);

/// The largest likelihood ratio of a point with a pinned value; 0 without one.
double max_ratio_of_pinned(const Proposal& proposal);

struct DrawnPoint {
  std::vector<double> z;
  bool natural{false};  ///< from the trials' own distribution
};

DrawnPoint draw(const TrialSpace& space, const Proposal& proposal, NumberSource& numbers);

/// A point of the trials' own distribution with this value.
std::vector<double> draw_pinned(const TrialSpace& space, const PinnedValue& pinned, NumberSource& numbers);

}  // namespace zerocount::rare
