#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "experiments/randomness/discrete_draws.hpp"
#include "runners/rare/normal_mixture.hpp"

/// The probability of a rare failure. A trial is a function of independent standard normal coordinates, and
/// of further random numbers that follow from its number.
namespace zerocount::rare {

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
