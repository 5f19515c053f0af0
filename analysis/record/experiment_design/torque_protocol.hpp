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

/// Parameters of a torque protocol of one family: pulses of the torque with their ring-downs, ramps with
/// reversals, and two holds. Levels are fractions of the largest torque that is allowed.
struct ProtocolShape {
  double amplitude{0.55};  ///< Largest torque level of ramps and holds.
  double pulse{0.25};      ///< Torque level of the pulses.
  /// Number of pulses. In each the torque steps up, the oscillation decays, the torque steps back, and the
  /// oscillation decays again.
  double pulses{2.0};
  double reversals{4.0};  ///< Number of torque reversals between the ramps.
  /// Ratio of the torque magnitudes at successive reversals; below 1 the loops are nested.
  double nesting{0.8};
  /// Duration of all ramps as a proportion of the time without the pulses; the rest of it are the two holds.
  double ramp_time{0.3};
  double low_hold{0.5};       ///< Torque level of the first hold as a proportion of `amplitude`.
  double high_hold{1.0};      ///< Torque level of the second hold as a proportion of `amplitude`.
  double low_hold_time{0.5};  ///< Duration of the first hold as a proportion of the duration of both holds.
  double holds_first{0.0};    ///< 1: the holds come before the ramps. 0: after them.
};

/// A property of the protocol shape, and the values of it that a search tries.
struct ShapeAxis {
  double ProtocolShape::*property;
  std::vector<double> values;  ///< Values of the property that the search tries, in ascending order.
};

const std::vector<ShapeAxis>& shape_axes();

/// The limits within which a protocol shape becomes a protocol: largest torque, number of samples, ring-down
/// time.
struct ProtocolFrame {
  /// Kind of the axis, which sets the units in messages.
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  loop::DacParameters dac;
  double sample_time{5e-4};  ///< Sampling interval T, s.
  double max_torque{0.0};    ///< Largest torque that the protocol may use, N m.
  std::int64_t samples{0};   ///< Number of samples of the whole record, at least min_samples().
  /// Number of samples in which an oscillation of the rotor dies out. Each edge of a pulse is followed by as
  /// many samples. The number is also the shortest length of a ramp, because ramps must be slow.
  std::int64_t ring_down_samples{0};
};

/// A monotonic part of a protocol: the torque changes linearly from its previous value to `to`.
struct ProtocolSegment {
  double to{0.0};  ///< Torque at the end of the part, N m.
  std::int64_t samples{1};
};

/// The commanded torque of an experiment, sample by sample, as codes of the converter. The torque begins and
/// ends at 0.
struct TorqueProtocol {
  double sample_time{5e-4};  ///< Sampling interval T, s.
  std::vector<std::int64_t> codes;
  std::vector<double> torque;  ///< [sample] Torque, N m: the code of the converter times its step Δu.
};

/// The monotonic parts of the protocol that a shape gives within the frame, in order, with frame.samples
/// samples in all.
std::vector<ProtocolSegment> segments_of(const ProtocolShape& shape, const ProtocolFrame& frame);

TorqueProtocol sampled_protocol(std::span<const ProtocolSegment> segments, const ProtocolFrame& frame);

/// Smallest number of samples of a record that has room for every shape: a quarter for pulses, up to 17
/// ramps, two holds.
inline std::int64_t min_samples(const ProtocolFrame& frame) {
  return 40 * frame.ring_down_samples;
}

/// Number of pulses of the shape, reduced to those for which the frame has room: pulses may take a quarter of
/// the record.
std::int64_t pulses_in(const ProtocolShape& shape, const ProtocolFrame& frame);

}  // namespace zerocount::experiment_design
