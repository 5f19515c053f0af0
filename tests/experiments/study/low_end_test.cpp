// The lowest value that a parameter is designed for, against closed forms.
#include "experiments/study/low_end.hpp"

#include <boost/math/distributions/normal.hpp>

#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::study {
namespace {

class LowEndOfRandomDistributions : public ::testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// Of friction.k1 with this value.
  static LowEnd low_end_of(const std::string& k1) {
    return low_end(study_of(minimal_manifest("friction: {k1: " + k1 + "}\n")), 0, "friction.k1");
  }
  static void expect(LowEnd found, LowEnd::Kind kind, double value) {
    EXPECT_EQ(found.kind, kind);
    EXPECT_NEAR(found.value, value, 1e-11 * value);
  }

  static constexpr int rounds = 100;

 private:
  std::mt19937_64 random_{71};
};

const boost::math::normal_distribution<double> standard_normal;
const double normal_tail = boost::math::quantile(standard_normal, 0.001);  // −3.09

TEST_F(LowEndOfRandomDistributions, OfANumberIsTheNumber) {
  for (int round = 0; round < rounds; ++round) {
    const double k1 = uniform(1.0, 1000.0);
    expect(low_end_of(fmt::format("{}", k1)), LowEnd::Kind::number, k1);
  }
}

TEST_F(LowEndOfRandomDistributions, OfABoundedDistributionIsTheEndOfItsSupport) {
  for (int round = 0; round < rounds; ++round) {
    const double low = uniform(1.0, 500.0), middle = low + uniform(0.0, 100.0);
    const double high = middle + uniform(1.0, 100.0);
    for (const std::string& k1 : {fmt::format("{{uniform: [{}, {}]}}", low, high),
                                  fmt::format("{{log_uniform: [{}, {}]}}", low, high),
                                  fmt::format("{{triangular: [{}, {}, {}]}}", low, middle, high),
                                  fmt::format("{{choice: [{}, {}, {}]}}", middle, low, high)}) {
      expect(low_end_of(k1), LowEnd::Kind::support, low);
    }
    const auto whole = static_cast<std::int64_t>(low);
    expect(low_end_of(fmt::format("{{integers: [{}, {}]}}", whole, whole + 7)), LowEnd::Kind::support,
           static_cast<double>(whole));
  }
}

// One in a thousand is lower. ln X of a lognormal is normal with the standard deviation √ln(1 + cv²).
TEST_F(LowEndOfRandomDistributions, OfALognormalIsItsQuantile) {
  for (int round = 0; round < rounds; ++round) {
    const double median = uniform(1.0, 500.0), cv = uniform(0.01, 2.0);
    expect(low_end_of(fmt::format("{{lognormal: {{median: {}, cv: {}}}}}", median, cv)), LowEnd::Kind::tail,
           median * std::exp(normal_tail * std::sqrt(std::log1p(cv * cv))));
  }
}

// With the parent's distribution function Φ, P(X ≤ x) = (Φ(x) − Φ(low))/(Φ(high) − Φ(low)) = 0.001.
TEST_F(LowEndOfRandomDistributions, OfATruncatedNormalIsItsQuantile) {
  for (int round = 0; round < rounds; ++round) {
    const double mean = uniform(50.0, 200.0), sd = uniform(5.0, 100.0);
    const double low = mean - uniform(0.1, 2.0) * std::min(sd, 0.45 * mean);
    const double high = mean + uniform(0.1, 4.0) * sd;
    const LowEnd found = low_end_of(
        fmt::format("{{truncated_normal: {{mean: {}, sd: {}, low: {}, high: {}}}}}", mean, sd, low, high));
    EXPECT_EQ(found.kind, LowEnd::Kind::tail);
    const auto below = [&](double x) { return boost::math::cdf(standard_normal, (x - mean) / sd); };
    EXPECT_NEAR((below(found.value) - below(low)) / (below(high) - below(low)), 0.001, 1e-9);
    EXPECT_GT(found.value, low);
  }
}

// A plain normal distribution is for values that may have either sign.
TEST_F(LowEndOfRandomDistributions, OfANormalIsItsQuantile) {
  for (int round = 0; round < rounds; ++round) {
    const double mean = uniform(-10.0, 10.0), sd = uniform(0.1, 5.0);
    const Study study = study_of(
        minimal_manifest(fmt::format("initial: {{position: {{normal: {{mean: {}, sd: {}}}}}}}\n", mean, sd)));
    const LowEnd found = low_end(study, 0, "initial.position");
    EXPECT_EQ(found.kind, LowEnd::Kind::tail);
    EXPECT_NEAR(found.value, mean + normal_tail * sd, 1e-11 * (std::abs(mean) + sd));
  }
}

// No trial but one in a thousand is drawn below it.
TEST_F(LowEndOfRandomDistributions, HardlyAnyTrialIsLower) {
  constexpr std::int64_t trials = 20'000;
  for (const std::string k1 : {"{lognormal: {median: 110, cv: 0.2}}", "{uniform: [80, 140]}",
                               "{truncated_normal: {mean: 110, sd: 30, low: 20, high: 200}}"}) {
    const Study study =
        study_of(minimal_manifest("friction: {k1: " + k1 + "}\n"), {fmt::format("trials={}", trials)});
    const LowEnd end = low_end(study, 0, "friction.k1");
    std::int64_t lower = 0;
    for (std::int64_t trial = 0; trial < trials; ++trial)
      lower += study_trial(study, 0, trial).inputs[column_of(study, "friction.k1")] < end.value;
    const double expected = end.kind == LowEnd::Kind::tail ? 0.001 * trials : 0.0;
    EXPECT_NEAR(static_cast<double>(lower), expected, 4.0 * std::sqrt(expected)) << k1;
  }
}

TEST(LowEnd, IsThatOfTheDesignPoint) {
  const Study study = study_of(
      minimal_manifest("friction: {k1: {uniform: [90, 120]}}\n"
                       "sweep: {cases: {plain: {}, soft: {friction.k1: 40}, loose: {friction.k1: {lognormal: "
                       "{median: 110, cv: 0.1}}}}}\n"));
  EXPECT_EQ(low_end(study, 0, "friction.k1").value, 90.0);
  EXPECT_EQ(low_end(study, 1, "friction.k1").kind, LowEnd::Kind::number);
  EXPECT_EQ(low_end(study, 1, "friction.k1").value, 40.0);
  EXPECT_EQ(low_end(study, 2, "friction.k1").kind, LowEnd::Kind::tail);
}

TEST(LowEnd, OfAProfileIsLeftToEachTrial) {
  const Study study = study_of(minimal_manifest(
      "friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2, marginal: lognormal}}}\n"));
  EXPECT_EQ(low_end(study, 0, "friction.k1").kind, LowEnd::Kind::profile);
}

}  // namespace
}  // namespace zerocount::study
