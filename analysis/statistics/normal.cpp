#include "analysis/statistics/normal.hpp"

#include "analysis/statistics/proportion.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::statistics {
double normal_quantile(double p) {
  return numerics::normal_quantile(p);
}

double normal_upper_tail(double z) {
  return numerics::normal_probability(-z);
}

double two_sided_normal_quantile(double confidence) {
  require_confidence(confidence);
  return normal_quantile(0.5 * (1.0 + confidence));
}

}  // namespace zerocount::statistics
