#include "experiments/designs/random.hpp"

#include <Random123/philox.h>
#include <fmt/format.h>

#include "experiments/designs/sha256.hpp"

namespace zerocount {

RandomKey random_key(std::uint64_t seed, std::string_view name) {
  const Sha256 digest = sha256(fmt::format("{}:{}", seed, name));
  RandomKey key{};
  for (std::size_t word = 0; word < key.size(); ++word) {
    for (std::size_t byte = 0; byte < 4; ++byte) {
      key[word] |= static_cast<std::uint32_t>(digest[4 * word + byte]) << (8 * byte);
    }
  }
  return key;
}

std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, std::uint32_t draw) {
  const r123::Philox4x32::key_type key{{stream.key[0], stream.key[1]}};
  const r123::Philox4x32::ctr_type counter{
      {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), draw, stream.stream}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32{}(counter, key);
  return words[0] | static_cast<std::uint64_t>(words[1]) << 32;
}

std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, Draw draw) {
  return random_bits(stream, index, static_cast<std::uint32_t>(draw));
}

double open_uniform(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

}  // namespace zerocount
