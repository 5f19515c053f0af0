#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace zerocount::sliding_identification {

struct SlidingFit;
struct SlidingRecord;

/// A torque against the drive that depends on the position x as read: a·sin(κ·x) + b·cos(κ·x), such as
/// gravity (once a revolution) and cogging; or a·x.
struct PositionWave {
  /// Number of periods per revolution, or per pitch of a linear axis; 0: torque proportional to x.
  double periods{0.0};
  double wave_number{0.0};  ///< Wave number κ, 1/rad or 1/m.
};

/// Largest number of position-dependent torques (waves) in a fit. Each wave has two amplitudes, those of sine
/// and cosine, one wave after the other.
inline constexpr std::size_t max_position_waves = 4;
inline constexpr std::size_t position_terms = 2 * max_position_waves;

/// [term] sin(κ·x) and cos(κ·x) of each wave, or x and 0; 0 for waves that the fit does not have.
using PositionShape = std::array<double, position_terms>;

PositionShape shape_at(double x, std::span<const PositionWave> waves);

/// Stores, for each sample of the records, sin(κ·x) and cos(κ·x) of the waves, so that a fit can estimate
/// their amplitudes.
void set_position_waves(std::vector<SlidingRecord>& records, std::span<const PositionWave> waves);

/// The position-dependent torque (wave), not yet in the fit, that explains the unexplained torque of the
/// windows best. The tried waves have up to 1000 periods in a revolution or pitch; for a linear axis a torque
/// proportional to the position is tried as well. A usual wave (see usual_waves()) is taken unless another
/// one explains clearly more than it. Nothing if no wave explains more than chance would.
///
/// The torque of the windows is regressed on the linear terms of the law (acceleration, direction, velocity,
/// 1 and the fit's waves), with and without the wave, because the law has absorbed a part of it.
std::optional<PositionWave> strongest_wave(const SlidingFit& fit);

/// The position-dependent torques (waves) to try first. For a rotary axis: once a revolution, like gravity.
/// For a linear axis: proportional to the position.
std::vector<PositionWave> usual_waves(const SlidingRecord& record);

/// Significance of a position-dependent torque (wave) of the fit, from the covariance of its two amplitudes.
/// From 1 on, the confidence region of the amplitudes excludes 0.
/// @param wave index in SlidingFit::waves
double visibility_of(const SlidingFit& fit, std::size_t wave);

/// Another position-dependent torque (wave) of the fit that cannot be told from the wave with index `wave`
/// over the travel of the windows, because their numbers of periods within the travel differ by less than
/// one. Nothing if there is none.
std::optional<PositionWave> alike_wave(const SlidingFit& fit, std::size_t wave);

/// Name of a position-dependent torque: "ripple." and its number of periods per revolution or pitch, such as
/// "ripple.1"; "slope" if it is proportional to the position.
std::string name_of(const PositionWave& wave);

}  // namespace zerocount::sliding_identification
