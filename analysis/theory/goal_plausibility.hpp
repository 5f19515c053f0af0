#pragma once

#include <string>
#include <vector>

#include "experiments/study/study.hpp"

/// Goals that are allowed but that the encoder, its noise or the converter keeps an axis from meeting.
namespace zerocount::theory {

struct FrozenLoop;

/// A warning for each test that fails, at the design point and under the condition where it fails worst:
///
///   - a tolerance below half a count: at zero counts the axis stands anywhere within a count
///   - a band that the encoder's noise leaves too often, even of an axis that stands in the middle of its
///   count
///   - a tolerance that the noise, by the linear loop of trial_loops(), moves the axis out of too often
///   - a code of the converter that moves the axis by more than the whole band or tolerance even where its
///     friction is stiffest, Δu/(k1 + k2). The rule of the paper (issue 4 of its section 3), with k1, is
///     stricter than zero counts need (docs/hardware.md, dac-resolution)
///
/// A test fails at a point under a condition if it fails in each of the trials examined there, the first
/// ones: few of very many points are examined, evenly spread.
std::vector<std::string> doubtful_goals(const study::Study& study);

/// Largest proportion of moves whose |count error| is within the band at all of `samples` sampling instants:
/// the axis stands in the middle of its count, and the encoder has Gaussian noise.
///
///     proportion = (1 − 2·Q((band + ½)/noise))^samples,   Q the upper tail of the normal distribution
///
/// @param band counts @param noise rms, counts
double highest_rate_within_band(double band, double noise, double samples);

/// Standard deviation, rad (m), of the axis under noise of the encoder in a linear loop L, by
///
///     σ²·Δx²·1/π·∫ |L/(1 + L)|²·S dα over 0 … π,   S the spectrum of the noise, of mean 1.
///
/// @param noise σ, counts @param resolution Δx, rad (m) per count @param bandwidth of the noise, Hz
double motion_by_noise(const FrozenLoop& loop, double noise, double resolution, double bandwidth);

}  // namespace zerocount::theory
