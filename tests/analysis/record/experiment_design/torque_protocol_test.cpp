#include "analysis/record/experiment_design/torque_protocol.hpp"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace zerocount::experiment_design {
namespace {

ProtocolShape random_shape(std::mt19937_64& random) {
  ProtocolShape shape;
  for (const ShapeAxis& axis : shape_axes())
    shape.*axis.property =
        axis.values[std::uniform_int_distribution<std::size_t>(0, axis.values.size() - 1)(random)];
  return shape;
}

ProtocolFrame random_frame(std::mt19937_64& random) {
  ProtocolFrame frame;
  frame.sample_time = std::pow(10.0, std::uniform_real_distribution<double>(-5.0, -3.0)(random));
  frame.max_torque = std::uniform_real_distribution<double>(0.01, 0.4)(random);
  frame.ring_down_samples = std::uniform_int_distribution<std::int64_t>(30, 200)(random);
  frame.samples = min_samples(frame) + std::uniform_int_distribution<std::int64_t>(0, 20000)(random);
  return frame;
}

// The record has the asked length, whole codes, torques within the limit, and begins and ends at 0.
TEST(TorqueProtocol, EveryShapeFillsItsDuration) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 500; ++i) {
    const ProtocolFrame frame = random_frame(random);
    const ProtocolShape shape = random_shape(random);
    const std::vector<ProtocolSegment> segments = segments_of(shape, frame);
    const TorqueProtocol protocol = sampled_protocol(segments, frame);
    ASSERT_EQ(static_cast<std::int64_t>(protocol.torque.size()), frame.samples);
    ASSERT_EQ(protocol.codes.front(), 0);
    ASSERT_EQ(protocol.codes.back(), 0);
    for (std::size_t k = 0; k < protocol.torque.size(); ++k) {
      ASSERT_EQ(protocol.torque[k], static_cast<double>(protocol.codes[k]) * frame.dac.resolution);
      ASSERT_LE(std::abs(protocol.torque[k]), frame.max_torque + 0.5 * frame.dac.resolution);
    }
    for (const ProtocolSegment& segment : segments) ASSERT_GE(segment.samples, 1);
  }
}

// Edges of a pulse take one sample; all other parts between two levels are slow ramps.
TEST(TorqueProtocol, EdgesAreStepsAndRampsAreSlow) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    const ProtocolFrame frame = random_frame(random);
    const ProtocolShape shape = random_shape(random);
    std::int64_t edges = 0;
    double from = 0.0;
    for (const ProtocolSegment& segment : segments_of(shape, frame)) {
      if (segment.to != from && segment.samples == 1) ++edges;
      const bool slow =
          segment.to == from || segment.samples == 1 || segment.samples >= frame.ring_down_samples;
      ASSERT_TRUE(slow) << segment.samples;
      from = segment.to;
    }
    ASSERT_EQ(edges, 2 * pulses_in(shape, frame));
  }
}

}  // namespace
}  // namespace zerocount::experiment_design
