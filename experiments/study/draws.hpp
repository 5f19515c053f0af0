#pragma once

#include <cstdint>

#include "core/random/random_numbers.hpp"
#include "experiments/designs/sobol.hpp"
#include "experiments/study/study.hpp"

namespace zerocount {

/// The random numbers of one slot, or of the mean of one profile.
struct SlotRandomness {
  RandomKey key{};
  SobolDirections directions{};  ///< used by the design `sobol`
  RandomKey contacts{};          ///< of the contacts after the first, where each draws for itself
};

/// Number `index` of the `count` uniform numbers, in (0, 1), that a design spreads. In the designs
/// monte_carlo and saltelli each is by itself, whatever their count.
double design_uniform(Design design, const SlotRandomness& randomness, std::uint32_t stream,
                      std::uint64_t index, std::uint64_t count);

/// Key of sobol_place, in a study with this seed. No parameter has a name with a slash in it.
RandomKey sobol_place_key(std::uint64_t seed);

/// The point of a Sobol sequence that trial `index` takes where there are `rigs`: trials k·rigs …
/// (k + 1)·rigs − 1 proportion the points of the same numbers, in an order that is random for every k. In the
/// order of the trials a rig would have every rigs-th point alone, which for rigs = 2^m are all in one of 2^m
/// equal intervals.
std::uint64_t sobol_place(const RandomKey& key, std::uint64_t index, std::uint64_t rigs);

}  // namespace zerocount
