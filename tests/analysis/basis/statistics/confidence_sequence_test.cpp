// Bounds that hold at every sample size at once: by their definition, and by what they promise to who looks
// after every block.
#include <boost/math/special_functions/beta.hpp>

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Logarithm of the likelihood ratio of the beta mixture against the success probability p, by Boost's beta
/// function.
double evidence_against(double p, std::int64_t successes, std::int64_t trials) {
  const auto s = static_cast<double>(successes);
  const auto f = static_cast<double>(trials - successes);
  return std::log(boost::math::beta(s + 0.5, f + 0.5) / boost::math::beta(0.5, 0.5)) - s * std::log(p) -
         f * std::log1p(-p);
}

TEST(ConfidenceSequence, BoundsAreWhereTheMixtureIsTwentyTimesAsLikely) {
  for (const std::int64_t trials : {1, 2, 7, 40, 300}) {
    for (std::int64_t successes = 0; successes <= trials; ++successes) {
      const statistics::ConfidenceInterval bounds =
          statistics::confidence_sequence_bounds(successes, trials, 0.95);
      if (successes > 0) {
        EXPECT_NEAR(evidence_against(bounds.low, successes, trials), std::log(20.0), 1e-6);
      }
      if (successes < trials) {
        EXPECT_NEAR(evidence_against(bounds.high, successes, trials), std::log(20.0), 1e-6);
      }
      const double proportion = static_cast<double>(successes) / static_cast<double>(trials);
      EXPECT_LE(bounds.low, proportion);
      EXPECT_GE(bounds.high, proportion);
    }
  }
}

TEST(ConfidenceSequence, BoundsEndAtZeroAndOne) {
  EXPECT_EQ(statistics::confidence_sequence_bounds(0, 0, 0.95).low, 0.0);
  EXPECT_EQ(statistics::confidence_sequence_bounds(0, 0, 0.95).high, 1.0);
  EXPECT_EQ(statistics::confidence_sequence_bounds(0, 50, 0.95).low, 0.0);
  EXPECT_EQ(statistics::confidence_sequence_bounds(50, 50, 0.95).high, 1.0);
  EXPECT_NEAR(statistics::confidence_sequence_bounds(0, 50, 0.9).high,
              1.0 - statistics::confidence_sequence_bounds(50, 50, 0.9).low, 1e-12);
}

TEST(ConfidenceSequence, BoundsAreWiderThanThoseOfAFixedSampleSize) {
  for (const std::int64_t trials : {20, 1000, 100000, 10000000}) {
    for (const double proportion : {0.0, 0.1, 0.5, 0.99, 1.0}) {
      const auto successes = static_cast<std::int64_t>(proportion * static_cast<double>(trials));
      const statistics::ConfidenceInterval anytime =
          statistics::confidence_sequence_bounds(successes, trials, 0.95);
      const statistics::ConfidenceInterval fixed = statistics::clopper_pearson(successes, trials, 0.95);
      EXPECT_LE(anytime.low, fixed.low);
      EXPECT_GE(anytime.high, fixed.high);
      EXPECT_LT(anytime.high - anytime.low, 3.5 * (fixed.high - fixed.low)) << trials << " " << proportion;
    }
  }
}

struct Looks {
  int covered_always{0};  ///< number of studies whose confidence sequence covers the true rate at every look
  /// Number of studies whose confidence sequence covers the true rate at the look at which the study stops.
  int covered_at_end{0};
  /// Number of studies whose bounds for a single look cover the true rate at every look.
  int fixed_covered_always{0};
};

Looks look_after_every_block(double p, int studies) {
  std::mt19937_64 engine(17);
  Looks looks;
  for (int study = 0; study < studies; ++study) {
    std::int64_t successes = 0;
    bool always = true;
    bool fixed_always = true;
    for (std::int64_t trials = 25; trials <= 5000; trials += 25) {
      successes += std::binomial_distribution<std::int64_t>(25, p)(engine);
      const statistics::ConfidenceInterval bounds =
          statistics::confidence_sequence_bounds(successes, trials, 0.95);
      const bool covers = bounds.low <= p && p <= bounds.high;
      const statistics::ConfidenceInterval fixed = statistics::wilson(successes, trials, 0.95);
      always = always && covers;
      fixed_always = fixed_always && fixed.low <= p && p <= fixed.high;
      const bool narrow = bounds.high - bounds.low <= 0.08;
      if (narrow || trials == 5000) {
        looks.covered_at_end += covers;
        break;
      }
    }
    looks.covered_always += always;
    looks.fixed_covered_always += fixed_always;
  }
  return looks;
}

TEST(ConfidenceSequence, CoversHoweverOftenItIsEvaluated) {
  constexpr int studies = 400;
  for (const double p : {0.5, 0.8, 0.97, 0.999}) {
    const Looks looks = look_after_every_block(p, studies);
    // Of 400 with 95 % each, 368 are three standard deviations below.
    EXPECT_GE(looks.covered_always, 368) << p;
    EXPECT_GE(looks.covered_at_end, 368) << p;
    if (p < 0.9) {
      EXPECT_LT(looks.fixed_covered_always, 340) << p;  // those of one look do not
    }
  }
}

// Each look is after a whole round of the machines, whose probabilities of success differ: the bounds are
// those of their mean.
TEST(ConfidenceSequence, CoversTheMeanOfMachinesHoweverOftenItIsEvaluated) {
  constexpr int studies = 400;
  std::mt19937_64 engine(18);
  int covered = 0;
  for (int study = 0; study < studies; ++study) {
    std::vector<double> machines(20);
    for (double& p : machines) p = std::sqrt(std::uniform_real_distribution<double>()(engine));
    const double mean = std::accumulate(machines.begin(), machines.end(), 0.0) / 20.0;
    std::int64_t successes = 0;
    bool always = true, narrow = false;
    for (std::int64_t trials = 20; always && !narrow; trials += 20) {
      for (const double p : machines) successes += std::bernoulli_distribution(p)(engine);
      const statistics::ConfidenceInterval bounds =
          statistics::confidence_sequence_bounds(successes, trials, 0.95);
      always = bounds.low <= mean && mean <= bounds.high;
      narrow = bounds.high - bounds.low <= 0.08;
    }
    covered += always;
  }
  EXPECT_GE(covered, 368);
}

TEST(ProjectedTrials, AreTheSmallestNumberThatDecides) {
  for (const double proportion : {0.0, 0.03, 0.5, 0.9, 1.0}) {
    const auto successes = static_cast<std::int64_t>(1000 * proportion);
    const std::int64_t n = statistics::projected_trials(successes, 1000, 0.01, 0.95, 100, 10000000);
    const auto halfwidth = [&](std::int64_t trials) {
      const auto s = static_cast<std::int64_t>(std::llround(proportion * static_cast<double>(trials)));
      const statistics::ConfidenceInterval bounds = statistics::confidence_sequence_bounds(s, trials, 0.95);
      return 0.5 * (bounds.high - bounds.low);
    };
    EXPECT_EQ(n % 100, 0);
    EXPECT_LE(halfwidth(n), 0.01);
    EXPECT_GT(halfwidth(n - 100), 0.01);
  }
  EXPECT_EQ(statistics::projected_trials(500, 1000, 0.001, 0.95, 300, 1000), 1000);
}

}  // namespace
}  // namespace zerocount::testing
