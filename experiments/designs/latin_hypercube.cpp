#include "experiments/designs/latin_hypercube.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount::designs {
namespace {

// Enough rounds for equally likely permutations even of the smallest domains
// (tests/experiments/designs/latin_hypercube_test.cpp).
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

}  // namespace zerocount::designs
