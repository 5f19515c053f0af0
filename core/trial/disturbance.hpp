#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/motion/disturbance.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::trial {

/// A disturbance torque, or a kinematic error, that varies periodically along an angle: amplitude·sin(a +
/// phase), with a = periods·(θ + p) or, with a pitch, 2π·(θ + p)/pitch, p the initial position.
struct RippleParameters {
  double amplitude{0.0};  ///< Amplitude, N m, or rad for a kinematic error
  double periods{0.0};    ///< Number of periods per revolution
  double pitch{0.0};      ///< Length of one period of the ripple on a linear axis, m; 0: `periods` applies
  double phase{0.0};      ///< Phase at position 0, rad
};

/// A disturbance torque that varies sinusoidally in time: amplitude·sin(2π·frequency·t + phase).
struct VibrationParameters {
  double amplitude{0.0};  ///< Amplitude, N m
  double frequency{0.0};  ///< Frequency, Hz
  double phase{0.0};      ///< Phase at t = 0, rad
};

/// One point of the power spectral density of a random vibration torque.
struct SpectrumPoint {
  double frequency;  ///< Frequency, Hz, above 0
  double density;    ///< One-sided power spectral density, (N m)²/Hz, not negative
};

/// A random vibration with a given spectrum, drawn anew in each trial: a sum of lines, one in each of `lines`
/// bands whose ends have equal ratios. A line has the mean square of its band, ∫S df. S is interpolated
/// linearly between the points on logarithmic axes, or on linear axes next to a zero. The frequency of a line
/// is drawn evenly on a logarithmic scale from its band, its phase from [0, 2π).
struct SpectrumParameters {
  std::vector<SpectrumPoint> density;  ///< Points of the spectrum: at least two, at ascending frequencies
  int lines{100};
};

/// Parameters of the disturbance torque on the rotor, or on the load.
struct DisturbanceParameters {
  double torque{0.0};  ///< Constant torque, N m
  std::vector<RippleParameters> ripple{};
  std::vector<VibrationParameters> vibration{};
  std::vector<std::shared_ptr<const SpectrumParameters>> spectra{};
};

/// Mean square of a random vibration torque in the band from `low` to `high` (Hz): ∫S df, (N m)². The density
/// S is 0 outside the given points.
double mean_square(const SpectrumParameters& spectrum, double low, double high);

/// The ripples along the angle of a trial, without those of amplitude 0.
/// @param position initial position p, rad.
std::vector<motion::Ripple> ripples_of(const std::vector<RippleParameters>& ripples, double position);

/// The disturbance of a trial, without the terms of amplitude 0.
/// @param position initial position p, rad.
/// @param lines number of random lines that other disturbances of the trial have drawn before, so that each
/// gets random numbers of its own.
motion::Disturbance disturbance_of(const DisturbanceParameters& parameters, double position,
                                   const random::TrialRandomness& randomness, std::uint64_t lines = 0);

/// Number of lines of the random vibrations in a disturbance; each needs random numbers of its own.
std::uint64_t random_lines(const DisturbanceParameters& parameters);

}  // namespace zerocount::trial
