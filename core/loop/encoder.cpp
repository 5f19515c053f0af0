#include "core/loop/encoder.hpp"

#include <numbers>

namespace zerocount {

Encoder make_encoder(double counts_per_revolution, double phase) {
  return {2.0 * std::numbers::pi / counts_per_revolution, phase};
}

}  // namespace zerocount
