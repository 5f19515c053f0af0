#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/loop/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

/// Design of the experiment that tells the friction of an axis before it slides.
///
///     machines   = draws from the manifest, and its median machine
///     start      = a usual protocol, scaled down until it is safe on all machines
///     repeat       change one property of the protocol; keep the change if the parameters come out narrower
///                  (protocol_search.hpp) and it is still safe on all machines
///     answer     = simulate the record of the median machine, identify it, and report the intervals
namespace zerocount::experiment_design {

/// A protocol within a family: pulses of the torque with their ring-downs, ramps with reversals, two holds.
/// Levels are fractions of the largest torque that is allowed.
struct ProtocolShape {
  double amplitude{0.55};  ///< Largest level of ramps and holds.
  double pulse{0.25};      ///< Level of the pulses.
  double pulses{2.0};      ///< Number of pulses. Each steps up, rings down, steps back and rings down.
  double reversals{4.0};   ///< Number of reversals of the ramps.
  double nesting{0.8};     ///< Ratio of the magnitudes of successive reversals.
  /// Ramp time as a proportion of the time without the pulses; the rest are holds.
  double ramp_time{0.3};
  double low_hold{0.5};       ///< Level of the first hold as a proportion of the amplitude.
  double high_hold{1.0};      ///< Level of the second hold as a proportion of the amplitude.
  double low_hold_time{0.5};  ///< Time of the first hold as a proportion of the time of both holds.
  double holds_first{0.0};    ///< 1: the holds come before the ramps.
};

/// A property of the shape, and the values that a search tries.
struct ShapeAxis {
  double ProtocolShape::*property;
  std::vector<double> values;  ///< Values in ascending order.
};

const std::vector<ShapeAxis>& shape_axes();

/// The frame that a shape fills.
struct ProtocolFrame {
  /// Kind of the axis, which sets the units in messages.
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  loop::DacParameters dac;
  double sample_time{5e-4};  ///< T, s
  double max_torque{0.0};    ///< Largest allowed torque, N m.
  std::int64_t samples{0};   ///< Number of samples of the whole record, at least min_samples().
  /// Number of samples in which an oscillation dies out. Each edge of a pulse is followed by as many samples.
  /// It is also the shortest length of a ramp, because ramps must be slow.
  std::int64_t ring_down_samples{0};
};

/// A monotonic part of a protocol: the torque changes linearly from its previous value to `to`.
struct ProtocolSegment {
  double to{0.0};  ///< Torque at the end of the part, N m.
  std::int64_t samples{1};
};

/// The commanded torque of an experiment, sample by sample: codes of the converter. It begins and ends at 0.
struct TorqueProtocol {
  double sample_time{5e-4};  ///< T, s
  std::vector<std::int64_t> codes;
  std::vector<double> torque;  ///< [sample] Torque code·Δu, N m.
};

/// The parts of a protocol, in order, with frame.samples samples in all.
std::vector<ProtocolSegment> segments_of(const ProtocolShape& shape, const ProtocolFrame& frame);

TorqueProtocol sampled_protocol(std::span<const ProtocolSegment> segments, const ProtocolFrame& frame);

/// Samples of a record that has room for every shape: a quarter for pulses, up to 17 ramps, two holds.
inline std::int64_t min_samples(const ProtocolFrame& frame) {
  return 40 * frame.ring_down_samples;
}

/// The pulses of a shape for which the frame has room: a quarter of the record.
std::int64_t pulses_in(const ProtocolShape& shape, const ProtocolFrame& frame);

}  // namespace zerocount::experiment_design
