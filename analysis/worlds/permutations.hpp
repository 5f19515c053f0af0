#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/random/random_numbers.hpp"

namespace zerocount::worlds {

/// Number of permutations of a test.
inline constexpr int permutations = 399;

/// 0, 1, …, size − 1 in a random order (Fisher and Yates), with the numbers of one permutation.
std::vector<std::size_t> permutation_of(std::size_t size, const random::RandomKey& key, std::uint32_t number);

/// The p-value of a statistic that so many permutations reach: (1 + as_good)/(1 + permutations).
inline double p_value_of_permutations(std::int64_t as_good) {
  return static_cast<double>(1 + as_good) / static_cast<double>(1 + permutations);
}

}  // namespace zerocount::worlds
