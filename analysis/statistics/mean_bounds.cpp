#include "analysis/statistics/mean_bounds.hpp"

#include <cmath>

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/format.h>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::statistics {

ConfidenceInterval student_t(const Moments& sample, double confidence) {
  require_confidence(confidence);
  if (sample.n < 2) {
    return {unknown, unknown};
  }
  const auto n = static_cast<double>(sample.n);
  const double t = student_t_quantile(n - 1.0, 0.5 * (1.0 + confidence));
  const double half_width = t * sample.sd() / std::sqrt(n);
  return {sample.mean - half_width, sample.mean + half_width};
}

ConfidenceInterval poisson_bounds(double events, double confidence) {
  require_confidence(confidence);
  if (!(events >= 0.0)) {
    throw Failure(ExitCode::bad_input, fmt::format("{} events; expected 0 or more", events));
  }
  const double tail = 0.5 * (1.0 - confidence);
  return {events == 0.0 ? 0.0 : boost::math::gamma_p_inv(events, tail),
          boost::math::gamma_q_inv(events + 1.0, tail)};
}

}  // namespace zerocount::statistics
