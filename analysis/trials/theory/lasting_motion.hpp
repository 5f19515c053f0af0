#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// Decides how a recorded motion ends: at rest, or in a cycle that lasts.
///
/// A record of n samples is judged by its octaves: the last one are the samples n/2 … n − 1, the one before
/// n/4 … n/2 − 1. A motion that decays by a power of the time looks alike in all parts of a record, except in
/// its octaves.
namespace zerocount::theory {

/// Largest half range of the position of an axis that counts as standing, counts.
inline constexpr double max_standing_amplitude = 1.0;

/// Cycle (lasting oscillation) of a position.
struct Cycle {
  double amplitude{0.0};  ///< Mean over the periods of half of the range of the position, counts.
  double period{0.0};     ///< Mean period of the oscillation, samples.
};

/// Whether the position stays within a range of two counts over the last two octaves.
bool stands(std::span<const float> positions);

/// The cycle (oscillation) of a position in the last half of a record, if it lasts:
///
///   - half of its range is more than max_standing_amplitude, and the same in the octave before and in each
///     quarter of the last one, within 5 %
///   - a trend of more than 0.1 % through the four quarters, continued as a geometric series, changes it by
///   less than 10 %
///   - the position has four periods in the octave. A period lasts from one rise through the band from
///     middle − amplitude/2 to middle + amplitude/2 to the next: oscillations that are smaller than the band
///     do not count
std::optional<Cycle> lasting_cycle(std::span<const float> positions);

/// Whether the commanded torque of an axis at rest will not move it in future:
///
///   - its means over the last three octaves drift so little that twenty more octaves change them by less
///     than `tolerance`. An integral that rises at a constant rate doubles its drift with each octave
///   - or its range is alike in the quarters of the last octave, and within that of the octave before: it
///     oscillates quickly
///
/// @param torques [sample] commanded torque, N m
/// @param tolerance change of the torque that does not move the axis, N m
bool torque_has_settled(std::span<const float> torques, double tolerance);

}  // namespace zerocount::theory
