#include "analysis/basis/statistics/clusters/tolerance.hpp"

#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::statistics {
namespace {

/// Probability P(B ≤ k) of a binomial variable B of n trials with probability p, summed term by term.
double binomial_up_to(std::int64_t k, std::int64_t n, double p) {
  double sum = 0.0;
  for (std::int64_t i = 0; i <= k; ++i) {
    const auto a = static_cast<double>(i), b = static_cast<double>(n - i);
    sum += std::exp(std::lgamma(a + b + 1) - std::lgamma(a + 1) - std::lgamma(b + 1) + a * std::log(p) +
                    b * std::log1p(-p));
  }
  return sum;
}

/// Bounds by SciPy 1.10: binomtest(k, n, alternative='greater' and 'less').proportion_ci(confidence,
/// 'exact').
TEST(Tolerance, OneSidedBoundsMatchSciPy) {
  struct {
    std::int64_t k, n;
    double confidence, at_least, at_most;
  } const scipy[] = {
      {1000, 1000, 0.95, 0.997008750454751, 1.0},
      {999, 1000, 0.95, 0.9952650064245071, 0.9999487080210909},
      {950, 1000, 0.99, 0.931595106304369, 0.9647185001452565},
      {1, 10, 0.9, 0.010480741793786141, 0.3368477233068408},
      {123456, 1000000, 0.95, 0.12291521487208755, 0.1239983963793161},
  };
  for (const auto& [k, n, confidence, at_least, at_most] : scipy) {
    EXPECT_NEAR(proportion_at_least(k, n, confidence), at_least, 1e-11);
    EXPECT_NEAR(proportion_at_most(k, n, confidence), at_most, 1e-11);
  }
}

TEST(Tolerance, OneSidedBoundsAreTheEndsOfTheTwoSidedIntervalWithTwiceTheTail) {
  for (const std::int64_t n : {1, 7, 300}) {
    for (std::int64_t k = 0; k <= n; k += 1 + n / 9) {
      const ConfidenceInterval both = clopper_pearson(k, n, 0.9);
      EXPECT_NEAR(proportion_at_least(k, n, 0.95), both.low, 1e-13);
      EXPECT_NEAR(proportion_at_most(k, n, 0.95), both.high, 1e-13);
    }
  }
}

TEST(Tolerance, ClaimsHoldWithTheirConfidenceAtEveryRate) {
  for (const std::int64_t n : {20, 100}) {
    for (const double p : {0.2, 0.5, 0.9, 0.97, 0.99}) {
      double kept = 0.0;
      double before = 0.0;
      for (std::int64_t k = 0; k <= n; ++k) {
        const double up_to = binomial_up_to(k, n, p);
        if (success_claim(k, n, 0.95).success_at_least <= p) kept += up_to - before;
        before = up_to;
      }
      EXPECT_GE(kept, 0.95 - 1e-9) << n << " trials at " << p;
    }
  }
}

TEST(Tolerance, WithoutFailuresHasTheClosedFormOfWilks) {
  for (const std::int64_t n : {59, 1000, 100000}) {
    const SuccessClaim claim = success_claim(n, n, 0.95);
    EXPECT_NEAR(claim.success_at_least, std::pow(0.05, 1.0 / static_cast<double>(n)), 1e-12);
    EXPECT_NEAR(claim.failure_at_most, -std::expm1(std::log(0.05) / static_cast<double>(n)), 1e-15);
    EXPECT_NEAR(rule_of_three(claim) * static_cast<double>(n), 3.0, 0.005);
    EXPECT_NEAR(rule_of_three(claim), claim.failure_at_most, 0.03 * claim.failure_at_most);
  }
  EXPECT_TRUE(std::isnan(rule_of_three(success_claim(99, 100, 0.95))));
}

TEST(Tolerance, RanksMatchTheTablesOfWilks) {
  // The sample sizes of the first orders for 95 % content with 95 % confidence.
  EXPECT_EQ(tolerance_rank(58, 0.95, 0.95), 59);  // none of 58
  EXPECT_EQ(tolerance_rank(59, 0.95, 0.95), 59);
  EXPECT_EQ(tolerance_rank(92, 0.95, 0.95), 92);
  EXPECT_EQ(tolerance_rank(93, 0.95, 0.95), 92);
  EXPECT_EQ(tolerance_rank(123, 0.95, 0.95), 122);
  EXPECT_EQ(tolerance_rank(124, 0.95, 0.95), 122);
  EXPECT_EQ(tolerance_rank(0, 0.95, 0.95), 1);
}

TEST(Tolerance, RanksAreTheSmallestPossible) {
  for (const std::int64_t n : {10, 100, 500}) {
    for (const double content : {0.5, 0.9, 0.99}) {
      for (const double confidence : {0.9, 0.99}) {
        const std::int64_t rank = tolerance_rank(n, content, confidence);
        if (rank <= n) {
          EXPECT_GE(binomial_up_to(rank - 1, n, content), confidence - 1e-9);
        }
        EXPECT_LT(binomial_up_to(rank - 2, n, content), confidence + 1e-9);
      }
    }
  }
}

TEST(Tolerance, LimitsContainTheirProportionWithTheStatedConfidence) {
  std::mt19937_64 random(95);
  std::exponential_distribution<double> exponential;
  constexpr int rounds = 4000;
  for (const auto& [n, content] : {std::pair<int, double>{120, 0.95}, {400, 0.99}}) {
    const auto rank = static_cast<std::size_t>(tolerance_rank(n, content, 0.9));
    ASSERT_LE(rank, static_cast<std::size_t>(n));
    int kept = 0;
    for (int round = 0; round < rounds; ++round) {
      std::vector<double> values(static_cast<std::size_t>(n));
      for (double& value : values) value = exponential(random);
      std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank) - 1, values.end());
      kept += -std::expm1(-values[rank - 1]) >= content;
    }
    EXPECT_GE(kept, (0.9 - 0.015) * rounds);  // three standard errors
    EXPECT_LE(kept, 0.97 * rounds);           // and not by being far too wide
  }
}

TEST(Tolerance, SentencesStateTheClaim) {
  EXPECT_EQ(
      claim_sentence(success_claim(2995, 2995, 0.95)),
      "at least 99.9 % of axes succeed, with 95 % confidence (no failure in 2995 trials: not 100 %, but at "
      "most 0.1 % fail)");
  EXPECT_EQ(claim_sentence(success_claim(0, 0, 0.95)), "nothing: no trial");
  EXPECT_EQ(claim_sentence(success_claim(999, 1000, 0.95)),
            "at least 99.52 % of axes succeed, with 95 % confidence (1 failure in 1000 trials)");
  EXPECT_EQ(claim_sentence(success_claim(900, 1000, 0.99)),
            "at least 87.5 % of axes succeed, with 99 % confidence (100 failures in 1000 trials)");
  EXPECT_EQ(claim_sentence(success_claim(0, 300, 0.95)),
            "at most 1 % of axes succeed, with 95 % confidence (no success in 300 trials)");
  const ToleranceLimit limits[] = {{0.95, 0.062}, {0.999, std::nan("")}, {0.99, 0.081}};
  EXPECT_EQ(settling_sentence(limits), "95 % arrive within 0.062 s, 99 % within 0.081 s");
  EXPECT_EQ(settling_sentence({}), "");
}

TEST(Tolerance, ImpossibleContentsAndConfidencesAreRefused) {
  for (const double p : {0.0, 1.0, -0.5, std::nan("")}) {
    EXPECT_THROW(tolerance_rank(10, p, 0.95), Failure);
    EXPECT_THROW(tolerance_rank(10, 0.95, p), Failure);
    EXPECT_THROW(success_claim(5, 10, p), Failure);
  }
  EXPECT_THROW(success_claim(11, 10, 0.95), Failure);
}

}  // namespace
}  // namespace zerocount::statistics
