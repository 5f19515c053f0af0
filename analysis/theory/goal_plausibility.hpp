#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.hpp"

/// Goals that are allowed but that the encoder, its noise or the converter keeps an axis from meeting.
namespace zerocount::theory {

struct FrozenLoop;

/// A warning for each test that fails, at the design point and under the condition where it fails worst:
///
///   - a tolerance below what zero counts hold: half a count, and half of one more where targets in SI units
///     are rounded
///   - a band or tolerance that the encoder's noise leaves too often, over all samples that must be within
///   it:
///     by an axis that stands in the middle of its count, or by the linear loop of trial_loops()
///   - a code of the converter that moves the axis by more than the whole band or tolerance even where its
///     friction is stiffest, Δu/(k1 + k2). The rule of the paper (issue 4 of its section 3), with k1, is
///     stricter than zero counts need (docs/hardware.md, dac-resolution)
///   - those of moves (move_plausibility.hpp); those of the torque range without a goal too
///
/// A test of whole trials fails at a point under a condition if it fails in each of the trials examined
/// there, the first ones: few of very many points are examined, evenly spread. One of moves fails if it fails
/// for more of their moves than the goal permits, by more than chance.
std::vector<std::string> doubtful_goals(const study::Study& study);

/// Those of the tests that no value of the controller changes: the torque is too small for a move, its
/// reference is still on its way at `within`, or the encoder misplaces its target.
std::vector<std::string> goals_out_of_reach(const study::Study& study);

/// Largest proportion of moves whose |count error| is within the band at all of `samples` sampling instants:
/// the axis stands in the middle of its count, and the encoder has Gaussian noise.
///
///     proportion = (1 − 2·Q((band + ½)/noise))^samples,   Q the upper tail of the normal distribution
///
/// @param band counts @param noise rms, counts
double highest_rate_within_band(double band, double noise, double samples);

enum class NoiseAt {
  axis,  ///< L/(1 + L): how the noise moves the axis
  error  ///< 1/(1 + L): the error that the loop reads
};

struct NoiseResponse {
  double gain;                ///< standard deviation by that of the noise
  double correlated_samples;  ///< after which values are nearly independent (correlation at most 0.1)
};

/// The response G of a linear loop to noise of the encoder with the spectrum S, of mean 1:
///
///     gain² = R(0),   R(k) = 1/π·∫ |G|²·S·cos kα dα over 0 … π.
///
/// @param bandwidth of the noise, Hz
NoiseResponse response_to_noise(const FrozenLoop& loop, NoiseAt at, double bandwidth);

}  // namespace zerocount::theory
