#include "experiments/study/draws.hpp"

#include <fmt/format.h>

#include "experiments/designs/latin_hypercube.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::study {

double design_uniform(Design design, const SlotRandomness& randomness, std::uint32_t stream,
                      std::uint64_t index, std::uint64_t count) {
  const random::RandomStream numbers{.key = randomness.key, .stream = stream};
  switch (design) {
    case Design::latin_hypercube:
      return designs::latin_uniform(index, count, numbers);
    case Design::sobol:
      return designs::sobol_uniform(index, randomness.directions, numbers);
    case Design::monte_carlo:
    case Design::saltelli:
      break;
  }
  return random::open_uniform(random::random_bits(numbers, index, random::Draw::trial));
}

bool trials_stay_when_extended(Design design) {
  switch (design) {
    case Design::latin_hypercube:
      return false;
    case Design::monte_carlo:
    case Design::sobol:
    case Design::saltelli:
      break;
  }
  return true;
}

random::RandomKey sobol_place_key(std::uint64_t seed, Grouping grouping) {
  // The slash keeps it apart from names of parameters.
  return designs::random_key(seed, fmt::format("{}s/places", traits_of(grouping).name));
}

std::uint64_t sobol_place(const random::RandomKey& key, std::uint64_t index, std::uint64_t rigs) {
  const std::uint64_t round = index / rigs;
  const random::RandomStream order{.key = key, .stream = static_cast<std::uint32_t>(round)};
  return round * rigs + designs::latin_stratum(index % rigs, rigs, order);
}

std::uint64_t place_in_groups(Design design, const random::RandomKey& key, std::uint64_t unit,
                              std::uint64_t groups) {
  return design == Design::sobol && groups > 0 ? sobol_place(key, unit, groups) : unit;
}

}  // namespace zerocount::study
