#include "analysis/statistics/normal.hpp"

#include <boost/math/distributions/normal.hpp>

#include "analysis/statistics/proportion.hpp"

namespace zerocount::statistics {
namespace {

using StandardNormal = boost::math::normal_distribution<double>;

}  // namespace

double normal_quantile(double p) {
  return boost::math::quantile(StandardNormal(), p);
}

double normal_upper_tail(double z) {
  return boost::math::cdf(boost::math::complement(StandardNormal(), z));
}

double two_sided_normal_quantile(double confidence) {
  require_confidence(confidence);
  return normal_quantile(0.5 * (1.0 + confidence));
}

}  // namespace zerocount::statistics
