#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/sampling.hpp"

namespace zerocount::study {

using SquareMatrix = std::vector<std::vector<double>>;  ///< A square matrix of numbers: [row][column].

/// A Gaussian copula: the normal scores zᵢ = Φ⁻¹(uᵢ) of the values of some slots are correlated by R, and the
/// distribution of each value stays its own (Nelsen, An Introduction to Copulas, 2nd ed., 2006, section 2.3).
struct GaussianCopula {
  /// Slots (parameters in the plan) of the correlated values, in the order of R's columns.
  std::vector<std::uint32_t> slots;
  DrawLevel level{DrawLevel::trial};  ///< how often all of them are drawn: world, machine or trial
  SquareMatrix factor;  ///< Cholesky factor L of the correlation matrix R = L·Lᵀ, lower triangular
};

/// The Cholesky factor L of the correlation matrix R = L·Lᵀ, lower triangular; empty if R is not positive
/// definite.
std::optional<SquareMatrix> cholesky_factor(const SquareMatrix& correlations);

/// The correlated uniform number of member i of the Gaussian copula, in (0, 1): Φ(Σⱼ L(i, j)·Φ⁻¹(uⱼ)). The
/// first member keeps its independent number, and so does every member that is not correlated with an earlier
/// one.
/// @param member i, index in GaussianCopula::slots
/// @param independent returns the independent uniform number uⱼ in (0, 1) of member j
double copula_uniform(const GaussianCopula& copula, std::size_t member,
                      const std::function<double(std::size_t)>& independent);

/// The source of the random numbers of one slot (a parameter in the plan), or of the mean of one profile
/// along the axis.
struct SlotRandomness {
  random::RandomKey key{};
  /// Direction numbers of the Sobol sequence in this slot's dimension; used by the design `sobol`.
  designs::SobolDirections directions{};
  /// Key of the random numbers for contacts after the first of a trial, if values are drawn per contact.
  random::RandomKey contacts{};
  /// The design `sobol` has no directions for this slot and uses a Latin hypercube: the case for rates of
  /// aging.
  bool no_directions{false};

  bool operator==(const SlotRandomness&) const = default;
};

/// Number `index` of the `count` uniform numbers in (0, 1) that a design (Monte Carlo, Latin hypercube, Sobol
/// or Saltelli) gives one random quantity. The designs monte_carlo and saltelli do not depend on `count`.
double design_uniform(Design design, const SlotRandomness& randomness, std::uint32_t stream,
                      std::uint64_t index, std::uint64_t count);

/// Key of the random order in which Sobol points are used. With machines it is the order in which trials take
/// the points; with worlds, the order in which machines take them (trials, if the study has no machines).
random::RandomKey sobol_place_key(std::uint64_t seed, Grouping grouping);

/// Index of the point of the Sobol sequence that trial `index` uses in a study with `machines` machines. The
/// trials k·machines … (k + 1)·machines − 1 use the points with the same indices, in a random order for every
/// k. Without this permutation a machine would get every machines-th point, and for machines = 2^m all of
/// these lie in one of 2^m equal intervals.
std::uint64_t sobol_place(const random::RandomKey& key, std::uint64_t index, std::uint64_t machines);

/// Index of the design's point that a unit (a trial or a machine) uses, when the units are dealt to groups
/// (machines or worlds) in turns: sobol_place() for the design sobol, otherwise `unit` itself.
/// @param groups number of groups; 0: the units are not grouped
std::uint64_t place_in_groups(Design design, const random::RandomKey& key, std::uint64_t unit,
                              std::uint64_t groups);

}  // namespace zerocount::study
