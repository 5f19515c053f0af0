#include "analysis/statistics/mean_bounds.hpp"

#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "analysis/statistics/unknown.hpp"

namespace zerocount::statistics {

ConfidenceInterval student_t(const Moments& sample, double confidence) {
  require_confidence(confidence);
  if (sample.n < 2) {
    return {unknown, unknown};
  }
  const auto n = static_cast<double>(sample.n);
  const boost::math::students_t_distribution<double> distribution(n - 1.0);
  const double t = boost::math::quantile(distribution, 0.5 * (1.0 + confidence));
  const double half_width = t * sample.sd() / std::sqrt(n);
  return {sample.mean - half_width, sample.mean + half_width};
}

}  // namespace zerocount::statistics
