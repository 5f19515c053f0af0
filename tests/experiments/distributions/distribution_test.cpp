#include "experiments/distributions/distribution.hpp"

#include <boost/math/distributions/normal.hpp>

#include "experiments/designs/designs.hpp"
#include "experiments/distributions/random_field.hpp"
#include "tests/support/test.hpp"

namespace zerocount::distributions {
namespace {

struct Moments {
  double mean;
  double sd;
};

// Mean and standard deviation as integrals of the quantile function over (0, 1), by the midpoint rule.
Moments moments_of(const Distribution& distribution) {
  constexpr int n = 200000;
  double sum = 0.0;
  double squares = 0.0;
  const double centre = quantile(distribution, 0.5);
  for (int i = 0; i < n; ++i) {
    const double x = quantile(distribution, (i + 0.5) / n) - centre;
    sum += x;
    squares += x * x;
  }
  return {centre + sum / n, std::sqrt(squares / n - std::pow(sum / n, 2))};
}

void expect_moments(const Distribution& distribution, double mean, double sd) {
  const Moments moments = moments_of(distribution);
  EXPECT_NEAR(moments.mean, mean, 2e-4 * sd);
  EXPECT_NEAR(moments.sd, sd, 2e-3 * sd);
}

TEST(Distribution, MomentsMatchTheTextbook) {
  expect_moments(Uniform{600, 900}, 750, 300 / std::sqrt(12));
  const double log_ratio = std::log(20.0);
  const double log_mean = 1.9 / log_ratio;
  expect_moments(LogUniform{0.1, 2.0}, log_mean,
                 std::sqrt((4.0 - 0.01) / (2 * log_ratio) - log_mean * log_mean));
  expect_moments(Normal{-3, 2}, -3, 2);
  expect_moments(Triangular{0.25, 0.3, 0.35}, 0.3, 0.1 / std::sqrt(24));
  expect_moments(Triangular{0, 0, 3}, 1, std::sqrt(0.5));
  expect_moments(Integers{1, 30}, 15.5, std::sqrt((900 - 1) / 12.0));
  expect_moments(Choice{{1, 2, 6}}, 3, std::sqrt(14.0 / 3.0));
  expect_moments(Choice{{5, 5, 8}}, 6, std::sqrt(2.0));
}

TEST(Distribution, LognormalHasItsMedianAndItsCoefficientOfVariation) {
  for (const double cv : {0.05, 0.2, 1.0}) {
    const Lognormal lognormal{2.0e5, cv};
    EXPECT_NEAR(quantile(lognormal, 0.5) / 2.0e5, 1.0, 1e-14);
    const double mean = 2.0e5 * std::sqrt(1 + cv * cv);
    const Moments moments = moments_of(lognormal);
    EXPECT_NEAR(moments.mean / mean, 1.0, 1e-4 * cv);
    EXPECT_NEAR(moments.sd / moments.mean, cv, 5e-3 * cv);
  }
}

// Mean of a standard normal conditioned on (a, b): (φ(a) − φ(b)) / (Φ(b) − Φ(a)).
TEST(Distribution, TruncatedNormalHasTheMeanOfTheConditionedParent) {
  const boost::math::normal standard;
  for (const auto& [a, b] : {std::pair{-1.0, 2.0}, {3.0, 5.0}, {-9.0, -6.0}, {6.0, 9.0}, {-0.1, 0.1}}) {
    const bool upper = a > 0;
    const double mass = upper ? cdf(complement(standard, a)) - cdf(complement(standard, b))
                              : cdf(standard, b) - cdf(standard, a);
    const double mean = (pdf(standard, a) - pdf(standard, b)) / mass;
    EXPECT_NEAR(moments_of(TruncatedNormal{10, 2, 10 + 2 * a, 10 + 2 * b}).mean, 10 + 2 * mean, 1e-4);
  }
}

TEST(Distribution, WholeNumbersAreEquallyLikely) {
  const Integers integers{-2, 4};
  std::vector<int> counts(7, 0);
  for (int i = 0; i < 7000; ++i) ++counts[static_cast<std::size_t>(quantile(integers, (i + 0.5) / 7000) + 2)];
  EXPECT_EQ(counts, std::vector<int>(7, 1000));
  EXPECT_EQ(quantile(Integers{3, 3}, 0.9), 3.0);
}

std::vector<Distribution> examples() {
  return {Uniform{0, 1},
          Uniform{-7, 1e9},
          LogUniform{0.1, 2},
          Normal{1, 2},
          TruncatedNormal{0, 1, -0.5, 3},
          TruncatedNormal{0, 1, 5, 6},
          TruncatedNormal{0, 1, -6, -5},
          Lognormal{1, 0.3},
          Triangular{0, 0.5, 1},
          Triangular{0, 1, 1},
          Integers{1, 30},
          Choice{{3, 1, 2}}};
}

TEST(Distribution, EveryDrawIsInTheSupportUpToTheExtremes) {
  for (const Distribution& distribution : examples()) {
    const numerics::Interval values = support(distribution);
    for (const double u : {0x1p-53, 1e-9, 0.1, 0.5, 0.9, 1 - 1e-9, 1 - 0x1p-53}) {
      EXPECT_TRUE(numerics::contains(values, quantile(distribution, u)))
          << distribution.index() << " at " << u;
    }
  }
}

TEST(Distribution, QuantilesNeverFall) {
  for (const Distribution& distribution : examples()) {
    if (std::holds_alternative<Choice>(distribution)) continue;  // in the order of the list
    for (int i = 1; i < 1000; ++i)
      ASSERT_LE(quantile(distribution, (i - 0.5) / 1000), quantile(distribution, (i + 0.5) / 1000));
  }
}

TEST(Distribution, TheUpperEndOfAContinuousSupportIsNeverDrawn) {
  EXPECT_LT(quantile(Uniform{0.5, 1}, 1 - 0x1p-53), 1.0);
  EXPECT_LT(quantile(Triangular{0, 1, 1}, 1 - 0x1p-53), 1.0);
}

TEST(Distribution, OnlyIntegersAndChoicesOfThemAreWhole) {
  EXPECT_TRUE(whole_numbers_only(Integers{0, 1}));
  EXPECT_TRUE(whole_numbers_only(Choice{{0, 5, -3}}));
  EXPECT_FALSE(whole_numbers_only(Choice{{0, 0.5}}));
  EXPECT_FALSE(whole_numbers_only(Uniform{0, 1}));
}

// A manifest keeps its trials: these bits are those of every version and processor.
TEST(Distribution, DrawsNeverChangeByABit) {
  EXPECT_EQ(quantile(Normal{0, 1}, 0x1.8a65fb35a9954p-1), 0x1.7acfb2d51491dp-1);
  EXPECT_EQ(quantile(Normal{0, 1}, 1e-6), -0x1.30381a9799f7ep+2);
  EXPECT_EQ(quantile(Normal{0, 1}, 0.999), 0x1.8b8cbb720447p+1);
}

/// A distribution of every kind, with random parameters.
std::vector<Distribution> random_distributions(std::mt19937_64& numbers) {
  std::uniform_real_distribution<double> uniform(0.1, 2.0);
  const double low = uniform(numbers);
  const double high = low + uniform(numbers);
  const double sd = uniform(numbers);
  return {Uniform{low, high},
          LogUniform{low, high},
          Normal{low, sd},
          TruncatedNormal{low, sd, low - 0.5 * sd, high},
          TruncatedNormal{low, sd, low + 2.0 * sd, low + 5.0 * sd},
          Lognormal{low, sd},
          Triangular{low, std::midpoint(low, high), high},
          Integers{-3, static_cast<std::int64_t>(10.0 * low)},
          Choice{{high, low, high + 1.0}}};
}

TEST(Distribution, QuantileInvertsTheDistributionFunction) {
  std::mt19937_64 numbers(3);
  std::uniform_real_distribution<double> uniform(0.001, 0.999);
  for (int repetition = 0; repetition < 200; ++repetition) {
    for (const Distribution& distribution : random_distributions(numbers)) {
      const double u = uniform(numbers);
      const double x = quantile(distribution, u);
      const std::optional<double> found = uniform_of(distribution, x);
      ASSERT_TRUE(found) << "kind " << distribution.index();
      EXPECT_NEAR(quantile(distribution, *found), x, 1e-11 * (1.0 + std::abs(x)))
          << "kind " << distribution.index();
      const bool discrete =
          std::holds_alternative<Integers>(distribution) || std::holds_alternative<Choice>(distribution);
      if (!discrete) {
        EXPECT_NEAR(*found, u, 1e-11) << "kind " << distribution.index();
      }
    }
  }
}

TEST(Distribution, ScalingMultipliesTheDrawOfTheSameUniformNumber) {
  std::mt19937_64 numbers(4);
  std::uniform_real_distribution<double> uniform(0.001, 0.999);
  for (int repetition = 0; repetition < 100; ++repetition) {
    const double factor = repetition % 2 == 0 ? 4.0 : 5.0 * uniform(numbers);
    for (const Distribution& distribution : random_distributions(numbers)) {
      const Distribution multiple = scaled(distribution, factor);
      const double u = uniform(numbers);
      const double expected = factor * quantile(distribution, u);
      EXPECT_NEAR(quantile(multiple, u), expected, 1e-12 * (1.0 + std::abs(expected)))
          << "kind " << distribution.index();
      EXPECT_EQ(whole_numbers_only(multiple), factor == 4.0 && whole_numbers_only(distribution));
    }
  }
}

/// The centre of a distribution, which widened() keeps; empty for distributions that are not widened.
std::optional<double> centre_of(const Distribution& distribution) {
  if (const auto* d = std::get_if<Uniform>(&distribution)) return 0.5 * (d->low + d->high);
  if (const auto* d = std::get_if<LogUniform>(&distribution)) return std::sqrt(d->low * d->high);
  if (const auto* d = std::get_if<Normal>(&distribution)) return d->mean;
  if (const auto* d = std::get_if<TruncatedNormal>(&distribution)) return d->mean;
  if (const auto* d = std::get_if<Lognormal>(&distribution)) return d->median;
  if (const auto* d = std::get_if<Triangular>(&distribution)) return d->mode;
  return std::nullopt;
}

TEST(Distribution, WideningScalesTheDistanceFromTheCentre) {
  std::mt19937_64 numbers(5);
  std::uniform_real_distribution<double> uniform(0.001, 0.999);
  for (int repetition = 0; repetition < 100; ++repetition) {
    const double factor = 0.5 + 2.5 * uniform(numbers);
    for (const Distribution& distribution : random_distributions(numbers)) {
      const double u = uniform(numbers);
      const double before = quantile(distribution, u);
      const double after = quantile(widened(distribution, factor), u);
      const std::optional<double> centre = centre_of(distribution);
      const bool logarithmic =
          std::holds_alternative<Lognormal>(distribution) || std::holds_alternative<LogUniform>(distribution);
      if (!centre) {
        EXPECT_EQ(after, before) << "kind " << distribution.index();
      } else if (logarithmic) {
        EXPECT_NEAR(std::log(after / *centre), factor * std::log(before / *centre), 1e-9);
      } else {
        EXPECT_NEAR(after - *centre, factor * (before - *centre), 1e-9 * (1.0 + std::abs(before)))
            << "kind " << distribution.index();
      }
    }
  }
}

TEST(Distribution, AValueThatCannotBeDrawnHasNoUniformNumber) {
  EXPECT_FALSE(uniform_of(Uniform{1, 2}, 2.1));
  EXPECT_FALSE(uniform_of(LogUniform{1, 2}, 0.9));
  EXPECT_FALSE(uniform_of(TruncatedNormal{0, 1, -1, 1}, 1.5));
  EXPECT_FALSE(uniform_of(Lognormal{1, 0.1}, 0.0));
  EXPECT_FALSE(uniform_of(Integers{1, 3}, 2.5));
  EXPECT_FALSE(uniform_of(Choice{{1, 2, 6}}, 3.0));
  EXPECT_FALSE(uniform_of(Normal{0, 1}, std::numeric_limits<double>::infinity()));
}

// The correlation wanted: exp(−(d/ℓ)²) wrapped on the circle, 1 at d = 0.
double wrapped_correlation(double distance, double length) {
  double sum = 0.0;
  double at_zero = 0.0;
  for (int k = -60; k <= 60; ++k) {
    const double turn = 2 * std::numbers::pi * k;
    sum += std::exp(-std::pow((distance + turn) / length, 2));
    at_zero += std::exp(-std::pow(turn / length, 2));
  }
  return sum / at_zero;
}

double correlation_of(const std::vector<double>& spectrum, double distance) {
  double sum = 0.0;
  for (std::size_t m = 0; m < spectrum.size(); ++m)
    sum += spectrum[m] * std::cos(static_cast<double>(m) * distance);
  return sum;
}

TEST(RandomField, SpectrumGivesTheWrappedCorrelation) {
  for (const double length : {0.01, 0.2, 1.0, 3.0, max_correlation_length}) {
    const std::vector<double> spectrum = field_spectrum(length);
    EXPECT_NEAR(std::accumulate(spectrum.begin(), spectrum.end(), 0.0), 1.0, 1e-12);
    for (const double distance : {0.0, 0.3 * length, length, 2 * length, std::numbers::pi})
      EXPECT_NEAR(correlation_of(spectrum, distance), wrapped_correlation(distance, length), 5e-12) << length;
  }
}

TEST(RandomField, CorrelationFallsToOneOverEAtTheCorrelationLength) {
  for (const double length : {min_correlation_length, 0.05, 0.2, 1.0})
    EXPECT_NEAR(correlation_of(field_spectrum(length), length), 1 / std::numbers::e, 1e-10);
}

TEST(RandomField, SeriesHasNoNegligibleTerms) {
  EXPECT_LE(field_spectrum(0.2).size(), 53u);
  EXPECT_LE(field_spectrum(min_correlation_length).size(), 10500u);
  for (const double length : {0.01, 0.2, 1.0}) {
    const std::vector<double> spectrum = field_spectrum(length);
    EXPECT_GT(spectrum.back(), 1e-16);
  }
}

friction::Profile rotor_of(const ProfileDescription& description, std::uint64_t seed, std::string_view name) {
  return realise_profile(description, field_amplitudes(description), designs::random_key(seed, name));
}

struct Ensemble {
  double mean{0.0};
  double sd{0.0};
  double correlation{0.0};  // between two places
};

constexpr int seeds = 20000;

Ensemble ensemble_of(const ProfileDescription& description, double place, double other_place) {
  Ensemble e;
  double other_mean = 0.0;
  double squares = 0.0;
  double other_squares = 0.0;
  double products = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    const friction::Profile profile = rotor_of(description, static_cast<std::uint64_t>(seed), "friction.k1");
    const double x = friction::value_at(profile, place) - description.mean;
    const double y = friction::value_at(profile, other_place) - description.mean;
    e.mean += x / seeds;
    other_mean += y / seeds;
    squares += x * x / seeds;
    other_squares += y * y / seeds;
    products += x * y / seeds;
  }
  e.sd = std::sqrt(squares - e.mean * e.mean);
  const double other_sd = std::sqrt(other_squares - other_mean * other_mean);
  e.correlation = (products - e.mean * other_mean) / (e.sd * other_sd);
  e.mean += description.mean;
  return e;
}

// With n seeds the standard errors are sd/√n of the mean, sd/√(2n) of the standard deviation and (1 − ρ²)/√n
// of the correlation of normals; 5 of them are exceeded once in 1.7 million.
TEST(RandomField, NormalEnsembleHasTheGivenMeanSpreadAndCorrelation) {
  const ProfileDescription description{110, 0.1, 0.2, friction::Marginal::normal};
  for (const double place : {0.0, 2.0}) {
    const Ensemble e = ensemble_of(description, place, place + 0.2);
    EXPECT_NEAR(e.mean, 110, 5 * 11 / std::sqrt(seeds));
    EXPECT_NEAR(e.sd, 11, 5 * 11 / std::sqrt(2.0 * seeds));
    EXPECT_NEAR(e.correlation, 1 / std::numbers::e, 5 * (1 - std::exp(-2.0)) / std::sqrt(seeds));
  }
}

// The correlation of two lognormals is (exp(s²ρ) − 1)/(exp(s²) − 1). Their kurtosis widens the standard error
// of the standard deviation to sd·√((κ − 1)/4n), κ = 3 + 16 cv² + … < 5 here.
TEST(RandomField, LognormalEnsembleHasTheMeanAndSpreadOfTheParameterItself) {
  const double cv = 0.3;
  const Ensemble e = ensemble_of({110, cv, 0.2, friction::Marginal::lognormal}, 1.0, 1.2);
  const double s2 = std::log1p(cv * cv);
  EXPECT_NEAR(e.mean, 110, 5 * 33 / std::sqrt(seeds));
  EXPECT_NEAR(e.sd, 33, 5 * 33 / std::sqrt(1.0 * seeds));
  EXPECT_NEAR(e.correlation, std::expm1(s2 / std::numbers::e) / std::expm1(s2), 10 / std::sqrt(seeds));
}

TEST(RandomField, ProfilesArePeriodicAndReproducible) {
  const ProfileDescription description{110, 0.1, 0.2, friction::Marginal::lognormal};
  const friction::Profile profile = rotor_of(description, 4, "friction.k1");
  for (const double angle : {0.0, 1.0, 5.0}) {
    EXPECT_NEAR(friction::value_at(profile, angle), friction::value_at(profile, angle + 2 * std::numbers::pi),
                1e-9);
  }
  EXPECT_EQ(profile.cosine, rotor_of(description, 4, "friction.k1").cosine);
  EXPECT_NE(profile.cosine, rotor_of(description, 5, "friction.k1").cosine);
  EXPECT_NE(profile.cosine, rotor_of(description, 4, "friction.k2").cosine);
}

TEST(RandomField, ARealisedProfileStaysInsideItsLimits) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const friction::Profile profile =
        rotor_of({1.0, 0.5, 0.1, friction::Marginal::lognormal}, seed, "friction.breakaway");
    const numerics::Interval values = limits(profile);
    for (int i = 0; i < 500; ++i)
      ASSERT_TRUE(numerics::contains(values, friction::value_at(profile, 0.013 * i)));
  }
}

}  // namespace
}  // namespace zerocount::distributions
