#include "experiments/designs/sobol.hpp"

#include <algorithm>
#include <bit>

#include <boost/random/sobol.hpp>

namespace zerocount::designs {

std::size_t sobol_dimension_limit() {
  return boost::random::default_sobol_table::max_dimension;
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
