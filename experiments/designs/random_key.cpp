#include "experiments/designs/random_key.hpp"

#include <fmt/format.h>

#include "core/hash/sha256.hpp"

namespace zerocount::designs {

random::RandomKey random_key(std::uint64_t seed, std::string_view name) {
  const hash::Sha256 digest = hash::sha256(fmt::format("{}:{}", seed, name));
  random::RandomKey key{};
  for (std::size_t word = 0; word < key.size(); ++word) {
    for (std::size_t byte = 0; byte < 4; ++byte) {
      key[word] |= static_cast<std::uint32_t>(digest[4 * word + byte]) << (8 * byte);
    }
  }
  return key;
}

}  // namespace zerocount::designs
