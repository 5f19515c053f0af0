#include "tests/studies/proportion_bounds.hpp"

#include <boost/math/distributions/binomial.hpp>

namespace zerocount::testing {
namespace {

using Binomial = boost::math::binomial_distribution<double>;

::testing::AssertionResult judged(double chance, const char* side, double proportion, std::int64_t k,
                                  std::int64_t n) {
  if (chance <= 1.0 - study_confidence) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << k << " of " << n << " do not show a share " << side << " " << proportion << ": at " << proportion
         << " they have a chance of " << chance;
}

}  // namespace

::testing::AssertionResult proportion_above(double proportion, std::int64_t k, std::int64_t n) {
  const Binomial binomial(static_cast<double>(n), proportion);
  const double chance = k == 0 ? 1.0 : cdf(complement(binomial, static_cast<double>(k - 1)));
  return judged(chance, "above", proportion, k, n);
}

::testing::AssertionResult proportion_below(double proportion, std::int64_t k, std::int64_t n) {
  const Binomial binomial(static_cast<double>(n), proportion);
  return judged(cdf(binomial, static_cast<double>(k)), "below", proportion, k, n);
}

}  // namespace zerocount::testing
