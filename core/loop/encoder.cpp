#include "core/loop/encoder.hpp"

#include <cmath>
#include <numbers>

namespace zerocount {

Encoder make_encoder(double counts_per_revolution, double phase) {
  return {2.0 * std::numbers::pi / counts_per_revolution, phase};
}

std::int64_t read_count(const Encoder& encoder, double theta) {
  return static_cast<std::int64_t>(std::floor(theta / encoder.resolution + encoder.phase));
}

}  // namespace zerocount
