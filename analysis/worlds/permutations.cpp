#include "analysis/worlds/permutations.hpp"

#include <numeric>
#include <utility>

namespace zerocount::worlds {

std::vector<std::size_t> permutation_of(std::size_t size, const random::RandomKey& key,
                                        std::uint32_t number) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = size - 1; i > 0; --i) {
    const double u =
        random::open_uniform(random::random_bits({.key = key, .stream = number}, i, random::Draw::trial));
    std::swap(order[i], order[static_cast<std::size_t>(u * static_cast<double>(i + 1))]);
  }
  return order;
}

}  // namespace zerocount::worlds
