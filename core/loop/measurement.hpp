#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/encoder.hpp"
#include "core/loop/formulas.hpp"
#include "core/loop/parameters.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::loop {

/// Whether any of these errors makes the encoder's readings differ from those of an ideal encoder.
bool has_errors(const EncoderErrors& errors);

/// Constants of an encoder's noise, from its standard deviation and bandwidth.
/// @param sample_time T, s.
NoiseConstants<double> noise_constants(const EncoderErrors& errors, double sample_time);

/// Whether two ideal encoders can show these two counts at one and the same rotor angle. Let q be the number
/// of coarse counts in a fine one and a = (c − phase)·q + phase. In coarse counts, the fine count c stands
/// for the interval [a, a + q) and the coarse count n for [n, n + 1). The intervals must overlap by more than
/// 16·2⁻⁵²·(1 + |n|), so that rounding does not separate edges that coincide.
bool counts_agree(const Encoder& fine, const Encoder& coarse, const EncoderReading& reading);

/// An encoder with errors. The count at sample k, where the rotor is at θ, by these steps:
///
///   eccentricity   θ′ = θ + a·[sin(p + θ − γ) − sin(p − γ)],   p the initial position on the rotor
///                  x = θ′/Δx + phase
///   interpolation  x′ = x + A·[s(x) − s(phase)],   s(x) = sin(2π·(m + x)/P),   m = ⌊p/Δx⌋
///   noise          x″ = x′ + sd·w_k,   w_k = a·w_{k−1} + √(1 − a²)·z_k, w_0 = z_0,
///                  a = exp(−2π·bandwidth·T), z_k standard normal, number k of its key
///   rounding       r_k = ⌊x″⌋
///   missed counts  count_k = r_k − lost_k,   lost_k = lost_{k−1} + sgn(r_k − r_{k−1})·b_k,
///                  b_k of |r_k − r_{k−1}| counts at the probability of one, number k of its key
///
/// so that the systematic errors are relative to the trial's start, where the count is 0, and fixed on the
/// rotor: m + x is the position in counts from the rotor's zero, within a count. Missed counts are never
/// recovered. Counts passed forth and back between two samples are not modelled. No counts pass before the
/// first sample.
class ImperfectEncoder {
 public:
  /// Creates the encoder at the start of a trial.
  /// @param position position of the contact on the rotor at θ = 0, rad.
  /// @param sample_time T, s.
  /// @param noise, missed random number streams of the noise and of missed counts.
  ImperfectEncoder(const Encoder& encoder, const EncoderErrors& errors, double position, double sample_time,
                   std::uint64_t trial, const random::RandomStream& noise,
                   const random::RandomStream& missed);

  /// The count at sample k, the rotor being at θ (rad). Samples come in order.
  std::int64_t read(std::int64_t k, double theta);

 private:
  double interpolation_error(double x) const;
  double next_noise(std::int64_t k);  ///< Noise sd·w_k of sample k, counts; advances the noise process
  void miss_counts(std::int64_t k, std::int64_t raw);

  Encoder encoder_;
  EncoderErrors errors_;
  double position_;
  std::uint64_t trial_;
  random::RandomStream noise_;
  random::RandomStream missed_;
  double start_eccentricity_;  // sin(p − γ)
  double start_count_;         // m
  NoiseConstants<double> constants_;
  double noise_state_{0.0};  // w of the last sample
  double start_interpolation_{0.0};
  bool first_{true};
  std::int64_t last_raw_{0};  // r of the sample before
  std::int64_t lost_{0};
};

/// All encoders of a trial, with their errors. Without errors, read_count() gives their readings.
class Measurement {
 public:
  /// Creates the encoders.
  /// @param phase position of θ = 0 within a count of the fine and of the coarse encoder, in [0, 1).
  /// @param other_phase position of θ = 0 within a count of the encoder on the other mass.
  /// @param position position on the rotor (rad) at θ = 0.
  /// @param sample_time T, s, for the bandwidth of the encoders' noise.
  Measurement(const EncoderParameters& encoders, double phase, double position,
              const random::TrialRandomness& randomness, double sample_time = 1.0, double other_phase = 0.5);

  /// The counts of all encoders at sample k. Call with ascending k.
  /// @param theta angle of the mass that closes the loop, rad.
  /// @param other_theta angle of the other mass, rad.
  EncoderReading read(std::int64_t k, double theta, double other_theta = 0.0) {
    EncoderReading reading = ideal_ ? EncoderReading{read_count(fine_, theta), read_count(coarse_, theta)}
                                    : read_with_errors(k, theta);
    if (imperfect_other_) reading.other = imperfect_other_->read(k, other_theta);
    return reading;
  }

  /// Resolution of the fine encoder, rad per count
  double fine_resolution() const { return fine_.resolution; }
  double finest_resolution() const { return finest_; }  ///< Finest resolution of all encoders, rad per count
  double fine_per_coarse() const { return fine_per_coarse_; }  ///< Number of fine counts in a coarse one

  /// Number of samples so far at which the coarse count was impossible given the fine one: counts_agree() was
  /// false, and ideal encoders at this angle would not read the two counts either (rounding at an edge allows
  /// that). Always 0 if the encoders have no errors.
  std::int64_t disagreements() const { return disagreements_; }

 private:
  EncoderReading read_with_errors(std::int64_t k, double theta);

  Encoder fine_;
  Encoder coarse_;
  double finest_;
  double fine_per_coarse_;
  bool ideal_;
  ImperfectEncoder imperfect_fine_;
  ImperfectEncoder imperfect_coarse_;
  std::optional<ImperfectEncoder> imperfect_other_{};
  std::int64_t disagreements_{0};
};

}  // namespace zerocount::loop
