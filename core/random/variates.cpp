#include "core/random/variates.hpp"

#include <boost/math/distributions/binomial.hpp>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/numerics/normal_quantile_formula.hpp"
#include "core/numerics/real.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::random {

double standard_normal(std::uint64_t bits) {
  return numerics::normal_quantile(open_uniform(bits));
}

double standard_normal_noise(std::uint64_t bits) {
  return numerics::standard_normal_quantile(open_uniform(bits));
}

std::int64_t binomial_number(std::int64_t n, double probability, std::uint64_t bits) {
  if (n == 0 || probability <= 0.0) return 0;
  if (probability >= 1.0) return n;
  using numerics::Real;
  const double u = open_uniform(bits);
  if (u <= numerics::exp_of_draws(static_cast<double>(n) * numerics::log1p(-probability))) return 0;

  // By bisection, because Boost's quantile fails in some far tails of small probabilities.
  const boost::math::binomial_distribution<Real> happened(static_cast<double>(n), probability);
  std::int64_t below = 0;  // F(below) < u ≤ F(reached)
  std::int64_t reached = n;
  while (reached - below > 1) {
    const std::int64_t middle = below + (reached - below) / 2;
    if (boost::math::cdf(happened, Real(middle)) < Real(u)) {
      below = middle;
    } else {
      reached = middle;
    }
  }
  return reached;
}

}  // namespace zerocount::random
