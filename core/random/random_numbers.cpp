#include "core/random/random_numbers.hpp"

#include <Random123/philox.h>
#include <boost/math/distributions/binomial.hpp>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/numerics/normal_quantile_formula.hpp"
#include "core/numerics/real.hpp"

namespace zerocount::random {

std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, std::uint32_t draw) {
  const r123::Philox4x32::key_type key{{stream.key[0], stream.key[1]}};
  const r123::Philox4x32::ctr_type counter{
      {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), draw, stream.stream}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32{}(counter, key);
  return words[0] | static_cast<std::uint64_t>(words[1]) << 32;
}

std::uint64_t random_bits(const RandomStream& stream, std::uint64_t index, Draw draw) {
  return random_bits(stream, index, static_cast<std::uint32_t>(draw));
}

std::uint64_t random_bits_at(const RandomStream& stream, std::uint64_t trial, std::uint64_t k) {
  return random_bits(stream, trial + ((k >> 32) << 56), static_cast<std::uint32_t>(k));
}

double open_uniform(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

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
