#pragma once

#include <cstdint>

#include "core/loop/formulas.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// Δx of the encoder that closes the loop, rad per count (m on a linear axis).
inline double fine_resolution(const EncoderParameters& encoders) {
  return encoders.fine_length / encoders.fine;
}

/// Δx of the encoder read beside it, rad per count (m on a linear axis).
inline double coarse_resolution(const EncoderParameters& encoders) {
  return encoders.coarse_length / encoders.coarse;
}

/// Fine counts in a coarse one. Encoders of one revolution have exactly the ratio of their counts.
inline double fine_per_coarse(const EncoderParameters& encoders) {
  return encoders.fine / encoders.coarse * (encoders.coarse_length / encoders.fine_length);
}

inline bool has_other(const EncoderParameters& encoders) {
  return encoders.other.counts > 0.0;
}

/// Δx of the encoder of the other mass, rad per count (m on a linear axis); that of the fine one without it.
inline double other_resolution(const EncoderParameters& encoders) {
  return has_other(encoders) ? encoders.other.length / encoders.other.counts : fine_resolution(encoders);
}

/// Δx of the encoder that the velocity loop of a cascade reads.
inline double velocity_resolution(const EncoderParameters& encoders, const ControllerParameters& controller) {
  return controller.velocity_by_other ? other_resolution(encoders) : fine_resolution(encoders);
}

/// An incremental encoder: count = floor(θ/Δx + phase), θ measured from the start of the trial.
struct Encoder {
  double resolution{1.0};  ///< Δx, rad per count
  double phase{0.0};       ///< where in a count θ = 0 lies, in [0, 1)
};

/// Readings of the encoders at a sampling instant.
struct EncoderReading {
  std::int64_t fine{0};    ///< counts
  std::int64_t coarse{0};  ///< counts of the coarse encoder
  std::int64_t other{0};   ///< counts of the encoder of the other mass; 0 without it
};

/// The ideal encoders of a trial. @param phase of either, in [0, 1).
inline Encoder fine_encoder(const EncoderParameters& encoders, double phase) {
  return {fine_resolution(encoders), phase};
}
inline Encoder coarse_encoder(const EncoderParameters& encoders, double phase) {
  return {coarse_resolution(encoders), phase};
}

/// The count at the rotor angle θ (rad).
inline std::int64_t read_count(const Encoder& encoder, double theta) {
  return static_cast<std::int64_t>(ideal_count(theta, encoder.resolution, encoder.phase));
}

}  // namespace zerocount::loop
