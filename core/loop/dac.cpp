#include "core/loop/dac.hpp"

#include <algorithm>

#include "core/loop/formulas.hpp"

namespace zerocount::loop {

std::int64_t lowest_code(const DacParameters& dac) {
  return -(std::int64_t{1} << (dac.bits - 1));
}
std::int64_t highest_code(const DacParameters& dac) {
  return (std::int64_t{1} << (dac.bits - 1)) - 1;
}

double lowest_torque(const DacParameters& dac) {
  return std::max(static_cast<double>(lowest_code(dac)) * dac.resolution, -dac.limit);
}
double highest_torque(const DacParameters& dac) {
  return std::min(static_cast<double>(highest_code(dac)) * dac.resolution, dac.limit);
}

DacOutput convert(const DacParameters& dac, double torque) {
  const double wanted = wanted_code(torque, dac.resolution);
  const double code =
      clipped_code(wanted, static_cast<double>(lowest_code(dac)), static_cast<double>(highest_code(dac)));
  return {static_cast<std::int64_t>(code), code * dac.resolution, code != wanted};
}

bool has_errors(const DacParameters& dac) {
  [[maybe_unused]] const auto& [bits, resolution, offset, gain_error, nonlinearity, noise, sigma_delta,
                                limit] = dac;
  return offset != 0.0 || gain_error != 0.0 || nonlinearity != 0.0 || noise != 0.0;
}

double torque_with_errors(const DacParameters& dac, std::int64_t code) {
  const double above = static_cast<double>(code - lowest_code(dac));
  const double below = static_cast<double>(highest_code(dac) - code);
  const double range = above + below;
  const double bow = dac.nonlinearity * 4.0 * above * below / (range * range);
  return dac.resolution * (1.0 + dac.gain_error) * (static_cast<double>(code) + bow) + dac.offset;
}

}  // namespace zerocount::loop
