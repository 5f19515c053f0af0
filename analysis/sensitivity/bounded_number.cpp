#include "analysis/sensitivity/bounded_number.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

#include "core/failure.hpp"

namespace zerocount {

BoundedNumber held_share(BoundedNumber number) {
  if (std::isnan(number.value)) return {};
  number.low = std::min(number.low, number.value);
  number.high = std::max(number.high, number.value);
  if (number.value > 1.0) number.low /= number.value;
  if (number.value < 0.0) number.high -= number.value;
  return {std::clamp(number.value, 0.0, 1.0), std::clamp(number.low, 0.0, 1.0),
          std::clamp(number.high, 0.0, 1.0)};
}

double two_sided_normal_quantile(double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("a confidence of {}; expected one between 0 and 1", confidence));
  }
  return boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * confidence);
}

}  // namespace zerocount
