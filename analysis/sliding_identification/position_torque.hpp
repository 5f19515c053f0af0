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
  double periods{0.0};      ///< per revolution, or per pitch of a linear axis; 0: proportional to x
  double wave_number{0.0};  ///< κ, 1/rad or 1/m
};

/// Most waves of a fit, and their amplitudes: of sine and cosine in turns.
inline constexpr std::size_t max_position_waves = 4;
inline constexpr std::size_t position_terms = 2 * max_position_waves;

/// [term] sin(κ·x) and cos(κ·x) of each wave, or x and 0; 0 for waves that the fit does not have.
using PositionShape = std::array<double, position_terms>;

PositionShape shape_at(double x, std::span<const PositionWave> waves);

/// Gives each sample of the records its shape.
void set_position_waves(std::vector<SlidingRecord>& records, std::span<const PositionWave> waves);

/// The wave, none of the fit's, that the unexplained torque of the windows shows best: of up to 1000 periods
/// in a revolution or pitch, and of a linear axis proportional to the position. The usual one, once a
/// revolution or that of a linear axis, unless another one beside it explains visibly more. Nothing if no
/// wave explains more than chance.
///
/// The torque of the windows is regressed on what the law is linear in, acceleration, direction, velocity, 1
/// and the fit's waves, with and without the wave, because the law has taken a part of it.
std::optional<PositionWave> strongest_wave(const SlidingFit& fit);

/// The wave to try before all others: once a revolution, as gravity; of a linear axis proportional to the
/// position.
std::vector<PositionWave> usual_waves(const SlidingRecord& record);

/// From 1 on the amplitudes of a wave of the fit exclude 0 together, by their covariance.
double visibility_of(const SlidingFit& fit, std::size_t wave);

/// A wave of the fit that looks like this one over the travel of the windows: their numbers of periods differ
/// by less than one in it. Nothing if there is none.
std::optional<PositionWave> alike_wave(const SlidingFit& fit, std::size_t wave);

/// "ripple.1", with the periods; "slope" of a wave proportional to the position.
std::string name_of(const PositionWave& wave);

}  // namespace zerocount::sliding_identification
