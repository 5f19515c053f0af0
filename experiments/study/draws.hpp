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

using SquareMatrix = std::vector<std::vector<double>>;  ///< [row][column]

/// A Gaussian copula: the normal scores zᵢ = Φ⁻¹(uᵢ) of the values of some slots are correlated by R, and the
/// distribution of each value stays its own (Nelsen, An Introduction to Copulas, 2nd ed., 2006, section 2.3).
struct GaussianCopula {
  std::vector<std::uint32_t> slots;   ///< slots of the correlated values, in the order of R's columns
  DrawLevel level{DrawLevel::trial};  ///< how often all of them are drawn: world, machine or trial
  SquareMatrix factor;                ///< L, lower triangular, R = L·Lᵀ
};

/// The Cholesky factor L of the correlation matrix R, lower triangular; empty if R is not positive definite.
std::optional<SquareMatrix> cholesky_factor(const SquareMatrix& correlations);

/// The correlated uniform number of member i: Φ(Σⱼ L(i, j)·Φ⁻¹(uⱼ)). The first member keeps its independent
/// number, and so does every member that is not correlated with an earlier one.
/// @param member i, index in GaussianCopula::slots
/// @param independent returns the independent uniform number uⱼ in (0, 1) of member j
double copula_uniform(const GaussianCopula& copula, std::size_t member,
                      const std::function<double(std::size_t)>& independent);

/// The random numbers of one slot, or of the mean of one profile.
struct SlotRandomness {
  random::RandomKey key{};
  designs::SobolDirections directions{};  ///< used by the design `sobol`
  random::RandomKey contacts{};           ///< for contacts after the first, if values are drawn per contact
  /// The design `sobol` has no directions for this slot and uses a Latin hypercube: the case for rates of
  /// aging.
  bool no_directions{false};

  bool operator==(const SlotRandomness&) const = default;
};

/// Number `index` of the `count` uniform numbers in (0, 1) of a design. The designs monte_carlo and saltelli
/// do not depend on `count`.
double design_uniform(Design design, const SlotRandomness& randomness, std::uint32_t stream,
                      std::uint64_t index, std::uint64_t count);

/// Key of a random order of Sobol points: for machines the order in which trials take the points, for worlds
/// the order in which machines take them (trials, if the study has no machines).
random::RandomKey sobol_place_key(std::uint64_t seed, Grouping grouping);

/// Index of the Sobol point of trial `index` in a study with `machines` machines. The trials k·machines … (k
/// + 1)·machines − 1 use the points with the same indices, in a random order for every k. Without this
/// permutation a machine would get every machines-th point, and for machines = 2^m all of these lie in one of
/// 2^m equal intervals.
std::uint64_t sobol_place(const random::RandomKey& key, std::uint64_t index, std::uint64_t machines);

/// Index in the design of a unit (a trial or a machine) when the units are dealt to groups (machines or
/// worlds) in turns: sobol_place() for the design sobol, otherwise `unit` itself.
/// @param groups number of groups; 0: the units are not grouped
std::uint64_t place_in_groups(Design design, const random::RandomKey& key, std::uint64_t unit,
                              std::uint64_t groups);

}  // namespace zerocount::study
