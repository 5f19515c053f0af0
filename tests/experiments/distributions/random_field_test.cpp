#include "experiments/distributions/random_field.hpp"

#include "experiments/designs/random_key.hpp"
#include "tests/support/test.hpp"

namespace zerocount::distributions {
namespace {

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
    for (const double distance : {0.0, 0.3 * length, length, 2 * length, std::numbers::pi}) {
      EXPECT_NEAR(correlation_of(spectrum, distance), wrapped_correlation(distance, length), 5e-12) << length;
    }
  }
}

TEST(RandomField, CorrelationFallsToOneOverEAtTheCorrelationLength) {
  for (const double length : {min_correlation_length, 0.05, 0.2, 1.0}) {
    EXPECT_NEAR(correlation_of(field_spectrum(length), length), 1 / std::numbers::e, 1e-10);
  }
}

TEST(RandomField, TheSeriesIsNoLongerThanItMustBe) {
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
TEST(RandomField, NormalEnsembleHasTheMeanSpreadAndCorrelationAskedFor) {
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
