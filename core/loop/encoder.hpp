#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/loop/formulas.hpp"
#include "core/loop/parameters.hpp"

namespace zerocount::loop {

/// Resolution Δx of the fine encoder, which closes the loop, rad per count (m on a linear axis).
inline double fine_resolution(const EncoderParameters& encoders) {
  return encoders.fine_length / encoders.fine;
}

/// Resolution Δx of the coarse encoder, which is read beside the fine one, rad per count (m on a linear
/// axis).
inline double coarse_resolution(const EncoderParameters& encoders) {
  return encoders.coarse_length / encoders.coarse;
}

/// Number of fine counts in a coarse count. For two encoders of one revolution it is exactly the ratio of
/// their counts.
inline double fine_per_coarse(const EncoderParameters& encoders) {
  return encoders.fine / encoders.coarse * (encoders.coarse_length / encoders.fine_length);
}

inline bool has_other(const EncoderParameters& encoders) {
  return encoders.other.counts > 0.0;
}

/// Resolution Δx of the encoder on the other mass, rad per count (m on a linear axis). Without such an
/// encoder it is the Δx of the fine encoder.
inline double other_resolution(const EncoderParameters& encoders) {
  return has_other(encoders) ? encoders.other.length / encoders.other.counts : fine_resolution(encoders);
}

/// Resolution Δx of the encoder that the velocity loop of a cascade reads, rad per count (m on a linear
/// axis).
inline double velocity_resolution(const EncoderParameters& encoders, const ControllerParameters& controller) {
  return controller.velocity_by_other ? other_resolution(encoders) : fine_resolution(encoders);
}

/// An ideal incremental encoder: count = floor(θ/Δx + phase), θ measured from the start of the trial.
struct Encoder {
  double resolution{1.0};  ///< Resolution Δx, rad per count
  double phase{0.0};       ///< Position of the angle θ = 0 within a count, in [0, 1)
};

/// Counts of the encoders at a sampling instant.
struct EncoderReading {
  std::int64_t fine{0};    ///< Count of the fine encoder
  std::int64_t coarse{0};  ///< Count of the coarse encoder
  std::int64_t other{0};   ///< Count of the encoder on the other mass; 0 without one
};

/// The fine encoder of a trial, without errors.
/// @param phase position of θ = 0 within a count, in [0, 1); the coarse encoder has the same phase.
inline Encoder fine_encoder(const EncoderParameters& encoders, double phase) {
  return {fine_resolution(encoders), phase};
}
inline Encoder coarse_encoder(const EncoderParameters& encoders, double phase) {
  return {coarse_resolution(encoders), phase};
}

/// The count that an ideal encoder shows at the rotor angle θ (rad).
inline std::int64_t read_count(const Encoder& encoder, double theta) {
  return static_cast<std::int64_t>(ideal_count(theta, encoder.resolution, encoder.phase));
}

/// The counts before the first sample, as of a motion at the constant velocity v₀ up to the angle θ₀:
///
///   n_{−j} = n_0 − (⌊θ₀/Δx + phase⌋ − ⌊(θ₀ − j·v₀·T)/Δx + phase⌋).
///
/// Here n_0 is the first reading. If v₀ = 0, all of them are n_0.
struct CountsBefore {
  Encoder encoder{};
  double theta{0.0};        ///< Angle θ₀ at the first sample, rad
  double velocity{0.0};     ///< Velocity v₀ before the first sample, rad/s
  double sample_time{1.0};  ///< Sample time T, s
  double unit{1.0};         ///< One count of this encoder, in the counts that the controller reads
};

/// Largest number of counts that can have passed before the first sample. This limit keeps the torque finite
/// at any velocity.
inline constexpr double max_counted = 0x1p52;

/// Counts n_0 − n_{−j} passed in the j samples before the first one, in the counts that the controller reads.
/// @param samples j.
inline double counted_since(const CountsBefore& before, std::size_t samples) {
  const auto& [encoder, theta, velocity, sample_time, unit] = before;
  const double earlier = theta - static_cast<double>(samples) * velocity * sample_time;
  const double counted = ideal_count(theta, encoder.resolution, encoder.phase) -
                         ideal_count(earlier, encoder.resolution, encoder.phase);
  return unit * clamped(counted, -max_counted, max_counted);
}

/// Mean number of counts per sample before the first one, v₀·T/Δx, in the counts that the controller reads.
inline double counts_per_sample(const CountsBefore& before) {
  const double counted = before.velocity * before.sample_time / before.encoder.resolution;
  return before.unit * clamped(counted, -max_counted, max_counted);
}

/// Angles, velocity and encoder phases of the masses when a trial starts.
struct StartOfMotion {
  double phase{0.5};        ///< Position of θ = 0 within a count of the encoder that closes the loop, in [0,
                            /// < 1)
  double other_phase{0.5};  ///< Position of θ = 0 within a count of the encoder on the other mass, in [0, 1)
  double theta{0.0};        ///< Angle of the mass that closes the loop, rad.
  double other_theta{0.0};  ///< Angle of the other mass, rad.
  double velocity{0.0};     ///< Velocity of both masses, rad/s.
};

}  // namespace zerocount::loop
