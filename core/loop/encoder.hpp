#pragma once

#include <cmath>
#include <cstdint>

namespace zerocount {

/// An incremental encoder: count = floor(θ/Δx + phase), θ measured from the start of the trial.
struct Encoder {
  double resolution{1.0};  ///< Δx, rad per count
  double phase{0.0};       ///< where in a count θ = 0 lies, in [0, 1)
};

/// What the two encoders read at a sampling instant.
struct EncoderReading {
  std::int64_t fine{0};    ///< counts
  std::int64_t coarse{0};  ///< counts of the coarse encoder
};

/// @param counts_per_revolution a positive whole number.
Encoder make_encoder(double counts_per_revolution, double phase);

/// The count at the rotor angle θ (rad).
inline std::int64_t read_count(const Encoder& encoder, double theta) {
  return static_cast<std::int64_t>(std::floor(theta / encoder.resolution + encoder.phase));
}

}  // namespace zerocount
