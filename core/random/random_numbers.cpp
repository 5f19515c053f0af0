#include "core/random/random_numbers.hpp"

#include <Random123/philox.h>

namespace zerocount::random {

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

std::uint64_t random_bits_at(const RandomStream& stream, std::uint64_t trial, std::uint64_t k) {
  return random_bits(stream, trial + ((k >> 32) << 56), static_cast<std::uint32_t>(k));
}

double open_uniform(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

}  // namespace zerocount::random
