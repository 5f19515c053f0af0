#include "experiments/designs/designs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <boost/random/sobol.hpp>
#include <fmt/format.h>

#include "core/hash/sha256.hpp"

namespace zerocount::designs {

namespace {

// Enough rounds for equally likely permutations even of the smallest domains
// (tests/experiments/designs/saltelli_test.cpp).
constexpr std::uint32_t rounds = 8;

struct Domain {
  std::uint64_t a;
  std::uint64_t b;
};

// a·b ≥ count with a·b − count < a, so that cycle walking almost always ends after one step.
Domain domain_for(std::uint64_t count) {
  const auto a = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  return {a, (count + a - 1) / a};
}

std::uint64_t encipher(std::uint64_t value, const Domain& domain, const random::RandomStream& stream) {
  std::uint64_t left = value % domain.a;
  std::uint64_t right = value / domain.a;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const bool left_is_next = round % 2 == 0;
    std::uint64_t& changed = left_is_next ? left : right;
    const std::uint64_t hashed = left_is_next ? right : left;
    const std::uint64_t size = left_is_next ? domain.a : domain.b;
    const auto draw = static_cast<std::uint32_t>(random::Draw::latin_round) + round;
    changed = (changed + random::random_bits(stream, hashed, draw) % size) % size;
  }
  return left + domain.a * right;
}

}  // namespace

std::uint64_t latin_stratum(std::uint64_t index, std::uint64_t count, const random::RandomStream& stream) {
  const Domain domain = domain_for(count);
  std::uint64_t value = index;
  do {
    value = encipher(value, domain, stream);
  } while (value >= count);
  return value;
}

double latin_uniform(std::uint64_t index, std::uint64_t count, const random::RandomStream& stream) {
  const auto stratum = static_cast<double>(latin_stratum(index, count, stream));
  const double place = random::open_uniform(random::random_bits(stream, index, random::Draw::trial));
  // With very many strata the sum may round up to 1.
  return std::min((stratum + place) / static_cast<double>(count), 1.0 - 0x1p-53);
}

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

std::vector<SobolDirections> sobol_directions(std::span<const std::size_t> dimensions) {
  std::vector<SobolDirections> directions(dimensions.size());
  if (dimensions.empty()) return directions;
  const std::size_t dimension_count = *std::max_element(dimensions.begin(), dimensions.end()) + 1;
  boost::random::sobol engine(dimension_count);
  std::vector<std::uint64_t> point(dimension_count);
  for (std::size_t digit = 0; digit < std::tuple_size_v<SobolDirections>; ++digit) {
    // The Gray code of 2^(digit+1) − 1 is 2^digit, so that point equals one direction number. The engine
    // skips the origin, so its seed 0 is point 1.
    engine.seed((std::uint64_t{2} << digit) - 2);
    engine.generate(point.begin(), point.end());
    for (std::size_t i = 0; i < dimensions.size(); ++i) directions[i][digit] = point[dimensions[i]];
  }
  return directions;
}

std::uint64_t sobol_bits(std::uint64_t index, const SobolDirections& directions) {
  std::uint64_t bits = 0;
  for (std::uint64_t gray = index ^ (index >> 1); gray != 0; gray &= gray - 1) {
    bits ^= directions[static_cast<std::size_t>(std::countr_zero(gray))];
  }
  return bits;
}

double sobol_uniform(std::uint64_t index, const SobolDirections& directions,
                     const random::RandomStream& stream) {
  return random::open_uniform(sobol_bits(index, directions) ^
                              random::random_bits(stream, 0, random::Draw::sobol_shift));
}

}  // namespace zerocount::designs
