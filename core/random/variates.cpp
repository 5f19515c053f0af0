#include "core/random/variates.hpp"

#include <cmath>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>

#include "core/random/random_numbers.hpp"

namespace zerocount::random {
namespace {

// In double alone: the same steps on every machine, and faster.
using DoubleOnly = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace

double standard_normal(std::uint64_t bits) {
  return boost::math::quantile(boost::math::normal_distribution<double, DoubleOnly>(), open_uniform(bits));
}

std::int64_t binomial_number(std::int64_t n, double probability, std::uint64_t bits) {
  if (n == 0 || probability <= 0.0) return 0;
  if (probability >= 1.0) return n;
  const double u = open_uniform(bits);
  if (u <= std::exp(static_cast<double>(n) * std::log1p(-probability))) return 0;

  // Bisection, because Boost's own quantile finds no bracket for some far tails of small probabilities.
  const boost::math::binomial_distribution<double, DoubleOnly> happened(static_cast<double>(n), probability);
  std::int64_t below = 0;  // F(below) < u ≤ F(reached)
  std::int64_t reached = n;
  while (reached - below > 1) {
    const std::int64_t middle = below + (reached - below) / 2;
    if (boost::math::cdf(happened, static_cast<double>(middle)) < u) {
      below = middle;
    } else {
      reached = middle;
    }
  }
  return reached;
}

}  // namespace zerocount::random
