#include "experiments/designs/sobol.hpp"

#include <cmath>
#include <numeric>
#include <set>

#include <boost/random/sobol.hpp>
#include <gtest/gtest.h>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount {
namespace {

constexpr std::size_t dimension_count = 70;

std::vector<SobolDirections> all_directions() {
  std::vector<std::size_t> dimensions(dimension_count);
  std::iota(dimensions.begin(), dimensions.end(), std::size_t{0});
  return sobol_directions(dimensions);
}

TEST(Sobol, IsTheSequenceOfBoostAfterTheOrigin) {
  const auto directions = all_directions();
  boost::random::sobol engine(dimension_count);
  for (std::size_t d = 0; d < dimension_count; ++d) EXPECT_EQ(sobol_bits(0, directions[d]), 0u);
  for (std::uint64_t index = 1; index < 3000; ++index) {
    for (std::size_t d = 0; d < dimension_count; ++d) ASSERT_EQ(sobol_bits(index, directions[d]), engine());
  }
}

TEST(Sobol, ReachesFarPointsDirectly) {
  const auto directions = all_directions();
  for (const std::uint64_t index :
       {std::uint64_t{123'456'789}, std::uint64_t{1} << 40, (std::uint64_t{1} << 53) - 1}) {
    boost::random::sobol engine(dimension_count);
    engine.seed(index - 1);
    for (std::size_t d = 0; d < dimension_count; ++d) ASSERT_EQ(sobol_bits(index, directions[d]), engine());
  }
}

TEST(Sobol, ADimensionDoesNotDependOnTheOthersAskedFor) {
  const auto directions = all_directions();
  const std::vector<std::size_t> few{2, 69, 0};
  const auto alone = sobol_directions(few);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(alone[i], directions[few[i]]);
  EXPECT_TRUE(sobol_directions({}).empty());
}

TEST(Sobol, EveryAlignedBlockOfTrialsFillsEveryStratumOnce) {
  const auto directions = all_directions();
  for (std::size_t d = 0; d < dimension_count; ++d) {
    const RandomStream stream{random_key(9, std::to_string(d)), 0};
    for (const std::uint64_t block : {std::uint64_t{0}, std::uint64_t{3}, std::uint64_t{1000}}) {
      std::set<int> strata;
      for (std::uint64_t i = 64 * block; i < 64 * (block + 1); ++i) {
        strata.insert(static_cast<int>(64.0 * sobol_uniform(i, directions[d], stream)));
      }
      ASSERT_EQ(strata.size(), 64u) << "dimension " << d;
    }
  }
}

// The point of the design: the first two parameters of the table fill squares, shifted or not.
TEST(Sobol, TheFirstTwoDimensionsFillEverySquareOnce) {
  const auto directions = all_directions();
  std::set<std::pair<int, int>> squares;
  for (std::uint64_t i = 0; i < 256; ++i) {
    const double x = sobol_uniform(i, directions[0], {random_key(9, "x"), 0});
    const double y = sobol_uniform(i, directions[1], {random_key(9, "y"), 0});
    squares.insert({static_cast<int>(16 * x), static_cast<int>(16 * y)});
  }
  EXPECT_EQ(squares.size(), 256u);
}

TEST(Sobol, TheShiftDependsOnSeedNameAndStream) {
  const auto directions = all_directions();
  const double u = sobol_uniform(5, directions[0], {random_key(1, "a"), 0});
  EXPECT_NE(u, sobol_uniform(5, directions[0], {random_key(2, "a"), 0}));
  EXPECT_NE(u, sobol_uniform(5, directions[0], {random_key(1, "b"), 0}));
  EXPECT_NE(u, sobol_uniform(5, directions[0], {random_key(1, "a"), 1}));
}

TEST(Sobol, EveryParameterHasItsOwnDimension) {
  std::set<std::size_t> dimensions;
  for (const Parameter& parameter : parameter_table()) {
    EXPECT_TRUE(dimensions.insert(parameter.sobol_dimension).second) << parameter.name;
    EXPECT_LE(parameter.sobol_dimension, first_sobol_dimension_of_moves);
    EXPECT_EQ(parameter.per_move, parameter.sobol_dimension == first_sobol_dimension_of_moves);
  }
}

}  // namespace
}  // namespace zerocount
