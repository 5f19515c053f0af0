#include "analysis/statistics/poisson_bounds.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::statistics {

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
