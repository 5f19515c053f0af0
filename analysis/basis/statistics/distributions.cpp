#include "analysis/basis/statistics/distributions.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "analysis/basis/statistics/proportion.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::statistics {

using boost::math::complement;

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

double student_t_quantile(double degrees_of_freedom, double p) {
  return quantile(boost::math::students_t(degrees_of_freedom), p);
}

double student_t_upper_tail(double degrees_of_freedom, double t) {
  return cdf(complement(boost::math::students_t(degrees_of_freedom), t));
}

double chi_squared_quantile(double degrees_of_freedom, double p) {
  return quantile(boost::math::chi_squared(degrees_of_freedom), p);
}

double binomial_cdf(std::int64_t trials, double success, std::int64_t k) {
  return cdf(boost::math::binomial(static_cast<double>(trials), success), static_cast<double>(k));
}

double binomial_upper_tail(std::int64_t trials, double success, std::int64_t k) {
  return cdf(complement(boost::math::binomial(static_cast<double>(trials), success), static_cast<double>(k)));
}

double hypergeometric_at_least(std::int64_t failures, std::int64_t drawn, std::int64_t total,
                               std::int64_t k) {
  const auto unsigned_of = [](std::int64_t count) { return static_cast<unsigned>(count); };
  const boost::math::hypergeometric law(unsigned_of(failures), unsigned_of(drawn), unsigned_of(total));
  // No sample holds fewer, and Boost refuses fewer.
  if (k <= range(law).first) return 1.0;
  return cdf(complement(law, unsigned_of(k - 1)));
}

}  // namespace zerocount::statistics
