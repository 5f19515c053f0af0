#include "core/loop/dac.hpp"

#include <algorithm>
#include <cmath>

namespace zerocount {

std::int64_t lowest_code(const DacParameters& dac) {
  return -(std::int64_t{1} << (dac.bits - 1));
}
std::int64_t highest_code(const DacParameters& dac) {
  return (std::int64_t{1} << (dac.bits - 1)) - 1;
}

DacOutput convert(const DacParameters& dac, double torque) {
  const double wanted = std::nearbyint(torque / dac.resolution);  // half to even in the default rounding mode
  const double lowest = static_cast<double>(lowest_code(dac));
  const double highest = static_cast<double>(highest_code(dac));
  const double code = std::clamp(wanted, lowest, highest);
  return {static_cast<std::int64_t>(code), code * dac.resolution, code != wanted};
}

}  // namespace zerocount
