#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/motion/disturbance.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::trial {

/// A disturbance, or a kinematic error, that varies along an angle: amplitude·sin(a + phase), with a =
/// periods·(θ + p) or, with a pitch, 2π·(θ + p)/pitch, p the initial position.
struct RippleParameters {
  double amplitude{0.0};  ///< N m; rad of a kinematic error
  double periods{0.0};    ///< Periods per revolution
  double pitch{0.0};      ///< Length of one period, m; 0: `periods` applies
  double phase{0.0};      ///< rad
};

/// A disturbance that varies in time: amplitude·sin(2π·frequency·t + phase).
struct VibrationParameters {
  double amplitude{0.0};  ///< N m
  double frequency{0.0};  ///< Hz
  double phase{0.0};      ///< rad
};

/// A point of a power spectral density.
struct SpectrumPoint {
  double frequency;  ///< Hz, above 0
  double density;    ///< one-sided, (N m)²/Hz, not negative
};

/// A random vibration with a given spectrum, drawn anew in each trial: a sum of lines, one in each of `lines`
/// bands whose ends have equal ratios. A line has the mean square of its band, ∫S df. S is interpolated
/// linearly between the points on logarithmic axes, or on linear axes next to a zero. The frequency of a line
/// is drawn evenly on a logarithmic scale from its band, its phase from [0, 2π).
struct SpectrumParameters {
  std::vector<SpectrumPoint> density;  ///< Points of the spectrum: at least two, at ascending frequencies
  int lines{100};
};

/// The disturbance of the rotor, or of the load.
struct DisturbanceParameters {
  double torque{0.0};  ///< Constant torque, N m
  std::vector<RippleParameters> ripple{};
  std::vector<VibrationParameters> vibration{};
  std::vector<std::shared_ptr<const SpectrumParameters>> spectra{};
};

/// Mean square of the vibration in the band from `low` to `high` (Hz): ∫S df, (N m)². S is 0 outside the
/// points.
double mean_square(const SpectrumParameters& spectrum, double low, double high);

/// The ripples along an angle, without those of amplitude 0. @param position p, rad.
std::vector<motion::Ripple> ripples_of(const std::vector<RippleParameters>& ripples, double position);

/// The disturbance of a trial, without the terms of amplitude 0. @param position p, rad.
/// @param lines number of random lines that preceding disturbances of the trial have used.
motion::Disturbance disturbance_of(const DisturbanceParameters& parameters, double position,
                                   const random::TrialRandomness& randomness, std::uint64_t lines = 0);

/// Number of random lines of a disturbance.
std::uint64_t random_lines(const DisturbanceParameters& parameters);

}  // namespace zerocount::trial
