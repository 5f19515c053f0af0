#pragma once

#include <optional>

#include "core/friction/friction_model.hpp"
#include "core/trial/parameters.hpp"

/// Functions that find out which features of the batch engine's lanes (vectorised trials) a trial needs.
namespace zerocount::batch {

/// Kind of kernel (vectorised integration loop) that moves the rotor of a lane. The friction law decides it.
enum class LaneMotion { contact, coulomb, bristle, elements, free };

/// The kind of kernel that integrates a friction model; empty if no kernel has its law.
std::optional<LaneMotion> lane_motion(friction::FrictionModel model);

/// Whether the controller has blocks beyond the PID law, or the converter has a dither or carries its
/// rounding error over (sigma-delta).
bool has_blocks(const trial::TrialParameters& parameters);

/// Whether the torque may go on changing while the error stays 0, because the controller has a memory:
/// filters, a derivative filter, an observer, a leak, a queue, a dither or a carried-over rounding error.
bool remembers(const trial::TrialParameters& parameters);

/// Whether the fine encoder has noise that the vectorised sampling kernels simulate; false if a LaneLoop
/// simulates it.
bool needs_lane_noise(const trial::TrialParameters& parameters);

/// Whether the trial needs a scalar LaneLoop, because its control loop has a feature that the vectorised
/// sampling kernels lack: errors of an encoder other than noise of the fine one, errors of the converter,
/// missed samples, two phases, the coarse encoder, a reference with a profile, a plugin, measures of the true
/// motion, torque levels, a window of counts, the queues of a cascade, a limit of the amplifier, filters or
/// an observer that start with a held torque, or more filters than the kernels have.
bool needs_lane_loop(const trial::TrialParameters& parameters);

/// Whether the loop has no random errors: the counts depend on the angle alone, and the torque on the
/// converter's code alone.
bool is_certain(const trial::TrialParameters& parameters);

/// Whether the torque of a LaneLoop stays while count and error stay 0, provided that the controller has run
/// at this sample and at the one before. If the control has two phases, the answer holds for the fine phase.
bool is_steady_at_zero(const trial::TrialParameters& parameters);

/// Whether the torque on the rotor differs from the torque that the controller decided, because of a delay,
/// an amplifier, jitter, or a disturbance that varies.
bool needs_lane_drive(const trial::TrialParameters& parameters);
/// Whether the vectorised drive kernel can replace the scalar LaneDrive. The delay must be at most
/// max_lane_delay whole samples, or 0 with jitter. The amplifier, if any, must not settle within a sample.
bool needs_drive_kernel(const trial::TrialParameters& parameters);

}  // namespace zerocount::batch
