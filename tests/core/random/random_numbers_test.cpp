// The numbers drawn while a trial runs: one for every trial, number and stream, by Philox.
#include "core/random/random_numbers.hpp"

#include "tests/support/goodness_of_fit.hpp"
#include "tests/support/test.hpp"

namespace zerocount::random {
namespace {

constexpr RandomKey key{0xa4093822, 0x299f31d0};

TEST(RandomBitsAt, PacksTrialNumberAndStreamIntoTheCounter) {
  // The documented counter words, handed over one by one.
  EXPECT_EQ(random_bits_at({key, 0}, 0, 0), random_bits({key, 0}, 0, 0u));
  EXPECT_EQ(random_bits_at({key, 7}, 5, 9), random_bits({key, 7}, 5, 9u));
  EXPECT_EQ(random_bits_at({key, 7}, 0x12'3456'789a'bcde, 0xfe'dcba'9876),
            random_bits({key, 7}, 0xfe12'3456'789a'bcde, 0xdcba'9876u));
}

TEST(RandomBitsAt, DependsOnEveryBitOfTrialNumberAndStream) {
  // All coordinates with at most two bits set: were two of them packed into the same counter, two of the
  // numbers would be equal.
  struct Coordinates {
    std::uint64_t trial;
    std::uint64_t k;
    std::uint32_t stream;
  };
  std::vector<Coordinates> single{{0, 0, 0}};
  for (int bit = 0; bit < 56; ++bit) single.push_back({std::uint64_t{1} << bit, 0, 0});
  for (int bit = 0; bit < 40; ++bit) single.push_back({0, std::uint64_t{1} << bit, 0});
  for (int bit = 0; bit < 32; ++bit) single.push_back({0, 0, std::uint32_t{1} << bit});

  std::set<std::uint64_t> numbers;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < single.size(); ++i) {
    for (std::size_t j = i; j < single.size(); ++j) {
      if (i == j && i != 0) continue;  // the single bits come with i = 0
      numbers.insert(random_bits_at({key, single[i].stream | single[j].stream},
                                    single[i].trial | single[j].trial, single[i].k | single[j].k));
      ++drawn;
    }
  }
  EXPECT_EQ(numbers.size(), drawn);
}

// Normal and binomial numbers by inversion.

/// Standard normal distribution function Φ(z), computed with the C library alone.
long double normal_probability(double z) {
  return 0.5L * std::erfc(-static_cast<long double>(z) / std::sqrt(2.0L));
}

/// F(0), F(1), … of the binomial law, summed from logarithms of its terms, until nothing is added.
std::vector<long double> binomial_probabilities(std::int64_t n, double p) {
  std::vector<long double> sums;
  long double sum = 0.0L;
  const long double count = static_cast<long double>(n);
  const long double probability = p;
  for (std::int64_t j = 0; j <= n; ++j) {
    const long double happened = static_cast<long double>(j);
    const long double ways =
        std::lgamma(count + 1.0L) - std::lgamma(happened + 1.0L) - std::lgamma(count - happened + 1.0L);
    const long double term =
        std::exp(ways + happened * std::log(probability) + (count - happened) * std::log1p(-probability));
    sum += term;
    sums.push_back(sum);
    if (happened > count * probability && term < 1e-22L) break;
  }
  return sums;
}

using Normal = double (*)(std::uint64_t);
constexpr Normal both[] = {standard_normal, standard_normal_noise};

TEST(StandardNormal, IsTheInverseOfTheNormalDistribution) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = i % 2 == 0 ? random() : random() >> (random() % 64);  // also far down the tail
    const double u = open_uniform(bits);
    if (u > 0.5) continue;  // its probability is a difference from 1: see the symmetry
    for (const Normal normal : both) {
      const double z = normal(bits);
      // A relative error of z of some 2⁻⁵² is one of about z² times that in Φ.
      const double error = normal == standard_normal ? 4e-16 : 8e-16;
      EXPECT_NEAR(static_cast<double>(normal_probability(z) / u), 1.0, error * (4.0 + z * z)) << u;
    }
  }
}

/// The fast normal quantile is tested also at the limits between its three rational functions: u = 0.075 and
/// e⁻²⁵.
TEST(StandardNormal, TheFastFormForNoiseAgreesTo1e15) {
  std::mt19937_64 random(16);
  for (int i = 0; i < 200000; ++i) {
    const std::uint64_t near_edge =
        static_cast<std::uint64_t>(i % 2 == 0 ? 0.075 * 0x1p64 : 0x1p64 * std::exp(-25.0));
    const std::uint64_t bits = i % 3 == 0   ? random()
                               : i % 3 == 1 ? random() >> (random() % 64)
                                            : near_edge ^ (random() >> 54);
    const double exact = standard_normal(bits);
    ASSERT_NEAR(standard_normal_noise(bits), exact, 1e-15 * std::abs(exact)) << open_uniform(bits);
  }
}

TEST(StandardNormal, IsExactlyAntisymmetricAndBounded) {
  std::mt19937_64 random(12);
  for (const Normal normal : both) {
    for (int i = 0; i < 10000; ++i) {
      const std::uint64_t bits = random();
      ASSERT_EQ(normal(bits), -normal(~bits));
    }
    EXPECT_LT(normal(~std::uint64_t{0}), 8.21);
    EXPECT_GT(normal(~std::uint64_t{0}), 8.20);
  }
}

TEST(BinomialNumber, IsTheSmallestWithEnoughProbability) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int compared = 0;
  for (int law = 0; law < 300; ++law) {
    const auto n = static_cast<std::int64_t>(std::pow(10.0, 3.5 * unit(random)));
    const double p = law % 2 == 0 ? unit(random) : std::pow(10.0, -5.0 * unit(random));
    const std::vector<long double> sums = binomial_probabilities(n, p);
    for (int i = 0; i < 50; ++i) {
      const std::uint64_t bits = random();
      const long double u = open_uniform(bits);
      const std::int64_t j = binomial_number(n, p, bits);
      ASSERT_LE(j, n);
      ASSERT_LT(j, static_cast<std::int64_t>(sums.size()));
      const auto at = static_cast<std::size_t>(j);
      EXPECT_GE(static_cast<double>(sums[at] - u), -1e-12) << n << " " << p;
      if (j > 0) {
        EXPECT_LT(static_cast<double>(sums[at - 1] - u), 1e-12) << n << " " << p;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(BinomialNumber, ApproachesPoissonForManyTrialsOfSmallProbability) {
  // Le Cam: the two laws differ by less than n·p², here at most 1e-12.
  constexpr double mean = 3.0;
  for (const double n : {1e13, 7e15}) {
    std::vector<double> observed(12, 0.0);
    std::vector<double> expected(12, 0.0);
    constexpr int draws = 20000;
    double probability = std::exp(-mean);
    double rest = 1.0;
    for (std::size_t j = 0; j + 1 < expected.size(); ++j) {
      expected[j] = draws * probability;
      rest -= probability;
      probability *= mean / static_cast<double>(j + 1);
    }
    expected.back() = draws * rest;
    std::mt19937_64 random(14);
    for (int i = 0; i < draws; ++i) {
      const std::int64_t j = binomial_number(static_cast<std::int64_t>(n), mean / n, random());
      ++observed[static_cast<std::size_t>(std::min<std::int64_t>(j, 11))];
    }
    EXPECT_GT(testing::chi_square_probability(observed, expected), 1e-3);
  }
}

TEST(BinomialNumber, IsCertainAtTheEnds) {
  std::mt19937_64 random(15);
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t bits = random();
    EXPECT_EQ(binomial_number(0, 0.5, bits), 0);
    EXPECT_EQ(binomial_number(1000, 0.0, bits), 0);
    EXPECT_EQ(binomial_number(1000, 1.0, bits), 1000);
    EXPECT_EQ(binomial_number(1, 0.25, bits), open_uniform(bits) > 0.75 ? 1 : 0);
  }
}

TEST(BinomialNumber, StaysWithinItsBoundsAtTheLastUniforms) {
  for (const double p : {1e-300, 1e-15, 1e-6, 0.3, 0.5, 1.0 - 0x1p-53}) {
    for (const std::int64_t n : {1, 2, 423, 68303, 692490, 1000000000}) {
      EXPECT_GE(binomial_number(n, p, 0), 0);
      EXPECT_LE(binomial_number(n, p, ~std::uint64_t{0}), n);
      EXPECT_GE(binomial_number(n, p, ~std::uint64_t{0}), binomial_number(n, p, 0));
    }
  }
}

}  // namespace
}  // namespace zerocount::random
