#include "analysis/sensitivity/bounded_number.hpp"

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

#include "core/failure.hpp"

namespace zerocount {

double two_sided_normal_quantile(double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("a confidence of {}; expected one between 0 and 1", confidence));
  }
  return boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * confidence);
}

}  // namespace zerocount
