#include "core/numerics/normal_distribution.hpp"

#include <boost/math/distributions/normal.hpp>

#include "core/numerics/real.hpp"

namespace zerocount::numerics {
namespace {

using Normal = boost::math::normal_distribution<Real>;

}  // namespace

double normal_quantile(double p, double mean, double standard_deviation) {
  return static_cast<double>(boost::math::quantile(Normal(mean, standard_deviation), Real(p)));
}

double normal_probability(double z) {
  return static_cast<double>(boost::math::cdf(Normal(), Real(z)));
}

}  // namespace zerocount::numerics
