#include "analysis/record/experiment_design/torque_protocol.hpp"

#include <algorithm>
#include <cmath>

#include "core/loop/dac.hpp"

namespace zerocount::experiment_design {
namespace {

/// Number of samples at torque 0 before the first and after the last part of a protocol.
constexpr std::int64_t rest_samples = 25;

/// The ramps and the holds of a protocol shape. The number of samples of each segment is that of a hold, or 0
/// for a ramp, whose length is set later.
/// @param amplitude largest torque of ramps and holds, N m
/// @param hold_samples number of samples of both holds together
std::vector<ProtocolSegment> ramps_and_holds(const ProtocolShape& shape, double amplitude,
                                             std::int64_t hold_samples) {
  std::vector<ProtocolSegment> ramps;
  double level = amplitude;
  for (int reversal = 0; reversal <= static_cast<int>(shape.reversals); ++reversal) {
    ramps.push_back({level, 0});
    level *= -shape.nesting;
  }
  const auto low = static_cast<std::int64_t>(shape.low_hold_time * static_cast<double>(hold_samples));
  const double low_level = shape.low_hold * amplitude;
  const double high_level = shape.high_hold * amplitude;
  std::vector<ProtocolSegment> holds{
      {low_level, 0}, {low_level, low}, {high_level, 0}, {high_level, hold_samples - low}};
  if (shape.holds_first > 0.5) std::swap(ramps, holds);
  ramps.insert(ramps.end(), holds.begin(), holds.end());
  ramps.push_back({0.0, 0});
  // A ramp from a level to itself is none.
  std::vector<ProtocolSegment> parts;
  for (const ProtocolSegment& part : ramps) {
    if (part.samples > 0 || parts.empty() || part.to != parts.back().to) parts.push_back(part);
  }
  return parts;
}

}  // namespace

const std::vector<ShapeAxis>& shape_axes() {
  static const std::vector<ShapeAxis> axes{
      {&ProtocolShape::amplitude, {0.02, 0.03, 0.05, 0.07, 0.1, 0.14, 0.2, 0.28, 0.4, 0.55, 0.75, 1.0}},
      {&ProtocolShape::pulse, {0.02, 0.05, 0.1, 0.17, 0.25, 0.35, 0.5}},
      {&ProtocolShape::pulses, {1.0, 2.0, 4.0, 8.0, 16.0}},
      {&ProtocolShape::reversals, {2.0, 3.0, 4.0, 6.0, 8.0, 12.0}},
      {&ProtocolShape::nesting, {0.5, 0.65, 0.8, 0.9, 1.0}},
      {&ProtocolShape::ramp_time, {0.05, 0.1, 0.2, 0.3, 0.45, 0.6}},
      {&ProtocolShape::low_hold, {0.2, 0.35, 0.5, 0.65}},
      {&ProtocolShape::high_hold, {0.8, 0.9, 1.0}},
      {&ProtocolShape::low_hold_time, {0.3, 0.4, 0.5, 0.6, 0.7}},
      {&ProtocolShape::holds_first, {0.0, 1.0}}};
  return axes;
}

std::int64_t pulses_in(const ProtocolShape& shape, const ProtocolFrame& frame) {
  const std::int64_t room = frame.samples / (8 * frame.ring_down_samples);
  return std::clamp(static_cast<std::int64_t>(shape.pulses), std::int64_t{1}, room);
}

std::vector<ProtocolSegment> segments_of(const ProtocolShape& shape, const ProtocolFrame& frame) {
  const double pulse = shape.pulse * frame.max_torque;
  const double amplitude = shape.amplitude * frame.max_torque;
  std::vector<ProtocolSegment> segments{{0.0, rest_samples}};
  std::int64_t remaining = frame.samples - 2 * rest_samples;
  for (std::int64_t i = 0; i < pulses_in(shape, frame); ++i) {
    segments.push_back({pulse, 1});
    segments.push_back({pulse, frame.ring_down_samples - 1});
    segments.push_back({0.0, 1});
    segments.push_back({0.0, frame.ring_down_samples - 1});
    remaining -= 2 * frame.ring_down_samples;
  }
  const auto ramp_samples = static_cast<std::int64_t>(shape.ramp_time * static_cast<double>(remaining));
  std::vector<ProtocolSegment> parts = ramps_and_holds(shape, amplitude, remaining - ramp_samples);
  double travel = 0.0;
  double level = 0.0;
  for (const ProtocolSegment& part : parts) {
    travel += std::abs(part.to - level);
    level = part.to;
  }
  level = 0.0;
  for (ProtocolSegment& part : parts) {
    if (part.samples == 0) {
      const double proportion = std::abs(part.to - level) / travel;
      part.samples = std::max(frame.ring_down_samples,
                              static_cast<std::int64_t>(proportion * static_cast<double>(ramp_samples)));
    }
    level = part.to;
    remaining -= part.samples;
  }
  // The longer hold makes up for what the rounding of the ramps leaves.
  const auto longest = std::max_element(parts.begin(), parts.end(), [](const auto& one, const auto& other) {
    return one.samples < other.samples;
  });
  longest->samples += remaining;
  segments.insert(segments.end(), parts.begin(), parts.end());
  segments.push_back({0.0, rest_samples});
  return segments;
}

TorqueProtocol sampled_protocol(std::span<const ProtocolSegment> segments, const ProtocolFrame& frame) {
  TorqueProtocol protocol;
  protocol.sample_time = frame.sample_time;
  double from = 0.0;
  for (const ProtocolSegment& segment : segments) {
    for (std::int64_t i = 1; i <= segment.samples; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(segment.samples);
      const loop::DacOutput output = loop::convert(frame.dac, from + (segment.to - from) * part);
      protocol.codes.push_back(output.code);
      protocol.torque.push_back(output.torque);
    }
    from = segment.to;
  }
  return protocol;
}

}  // namespace zerocount::experiment_design
