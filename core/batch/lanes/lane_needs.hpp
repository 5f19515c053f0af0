#pragma once

#include <optional>

#include "core/friction/friction_model.hpp"
#include "core/trial/parameters.hpp"

/// Features of the lanes that a trial needs.
namespace zerocount::batch {

/// Kind of kernel that moves a lane. The friction law decides it.
enum class LaneMotion { contact, coulomb, bristle, elements, free };

/// The kind of kernel for a friction model; empty if the kernels lack its law.
std::optional<LaneMotion> lane_motion(friction::FrictionModel model);

/// Whether the controller has blocks beyond the PID law, or a dither or a remainder of the converter.
bool has_blocks(const trial::TrialParameters& parameters);

/// Whether the torque may change for ever while the error stays 0: by filters, a derivative filter, an
/// observer, a leak, a queue, a dither or a remainder.
bool remembers(const trial::TrialParameters& parameters);

/// Whether the fine encoder has noise that the sampling kernels read.
bool needs_lane_noise(const trial::TrialParameters& parameters);

/// Whether the sampled loop of the trial has a feature that the sampling kernels lack: errors of an encoder
/// other than noise of the fine one, errors of the converter, missed samples, two phases, the coarse encoder,
/// a reference with a profile, a plugin, measures of the true motion, torque levels, a window of counts, the
/// queues of a cascade, a limit of the amplifier, filters or an observer that start with a held torque, or
/// more filters than they have.
bool needs_lane_loop(const trial::TrialParameters& parameters);

/// Whether the counts depend on the angle alone, and the torque on the code alone.
bool is_certain(const trial::TrialParameters& parameters);

/// Whether the torque of a LaneLoop stays while count and error stay 0, provided that the controller has run
/// at this sample and at the one before. With two phases this is asked in the fine phase.
bool is_steady_at_zero(const trial::TrialParameters& parameters);

/// Whether the torque on the rotor differs from the decided one: by a delay, an amplifier, jitter, or a
/// disturbance that varies.
bool needs_lane_drive(const trial::TrialParameters& parameters);
/// Whether the drive kernel can replace the LaneDrive. The delay must be at most max_lane_delay whole
/// samples, or 0 with jitter. The amplifier, if any, must not settle within a sample.
bool needs_drive_kernel(const trial::TrialParameters& parameters);

}  // namespace zerocount::batch
