// What a controller knows of the motion before its first sample, and where a recorded reference leaves an
// axis.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/trial/trial.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// An axis in a cascade with the velocity of the reference fed forward, which follows a sine at whose speed
/// it starts.
struct StartedAxis {
  static constexpr unsigned seeds = 80;

  explicit StartedAxis(unsigned seed) : draws(seed) {
    p.friction.model = friction::FrictionModel::none;
    p.plant.presliding_damping = 0.0;
    p.encoder.fine = std::round(draws.log_uniform(1e5, 1e8));
    p.dac = {.bits = 32, .resolution = 1e-9};
    p.controller.sample_rate = draws.log_uniform(500.0, 20000.0);
    p.controller.delay = draws.uniform(0.0, 2.0);
    loop::ControlBlocks& blocks = p.controller.blocks;
    blocks.structure = loop::ControlStructure::cascade;
    blocks.cascade = {.kv = 60.0, .kp = 0.1, .ki = 4.0, .feedforward = 1.0};
    blocks.derivative_window = static_cast<int>(draws.integer(1, 8));
    if (draws.chance(0.5)) blocks.derivative_cutoff = draws.log_uniform(5.0, 500.0);
    if (draws.chance(0.4)) {
      p.plant.load = {.inertia = p.plant.inertia, .stiffness = 500.0, .damping = 0.02};
      if (draws.chance(0.5)) p.plant.load.encoder = motion::EncoderPlace::load;
    }
    p.command.profile = {.shape = loop::ReferenceShape::sine,
                         .amplitude = draws.log_uniform(1e-3, 1e-1),
                         .frequency = draws.uniform(0.5, 3.0)};
    p.command.targets = {0};
    p.command.hold = 20.0 / p.controller.sample_rate;
    p.initial.encoder_phase = draws.uniform(0.0, 1.0);
    p.initial.velocity =
        draws.sign() * 2.0 * std::numbers::pi * p.command.profile.frequency * p.command.profile.amplitude;
    if (p.initial.velocity < 0.0) p.command.profile.amplitude = -p.command.profile.amplitude;
  }

  /// [sample] torque that the control decides, N m.
  std::vector<double> torques() const {
    std::vector<double> all;
    trial::TrialObservers observers;
    observers.sample = [&](const trial::SampleRecord& record) { all.push_back(record.torque); };
    trial::run_trial(p, observers);
    return all;
  }

  /// Change of the torque (N m) if the encoder reads one count more: one count in the window of the velocity,
  /// and one count of the error.
  double torque_of_a_count() const {
    const loop::CascadeParameters& c = p.controller.blocks.cascade;
    const double count = loop::fine_resolution(p.encoder);
    const double velocity = count * (p.controller.sample_rate / p.controller.blocks.derivative_window + c.kv);
    return (c.kp + 0.5 * c.ki / p.controller.sample_rate) * velocity;
  }

  testing::Draws draws;
  trial::TrialParameters p{};
};

TEST_EACH_SEED(StartedAxis, NeedsNoTorqueAtItsFirstSample) {
  EXPECT_LT(std::abs(torques().front()), 1.01 * torque_of_a_count());
}

TEST_EACH_SEED(StartedAxis, NeedsATorqueStepIfItStartsFromRest) {
  const double velocity = std::exchange(p.initial.velocity, 0.0);
  const double jump = p.controller.blocks.cascade.kp * std::abs(velocity);
  EXPECT_GT(std::abs(torques().front()), 0.9 * jump);
}

/// A ramp, after which a cascade with feed-forward holds the axis at the record's end.
TEST(RecordedReference, LeavesTheAxisAtRestAtItsEnd) {
  trial::TrialParameters p;
  p.friction.model = friction::FrictionModel::none;
  p.dac = {.bits = 32, .resolution = 1e-9};
  p.controller.blocks.structure = loop::ControlStructure::cascade;
  p.controller.blocks.cascade = {.kv = 60.0, .kp = 0.4, .ki = 20.0, .feedforward = 1.0};
  p.controller.blocks.feedforward = {.velocity = 0.2, .acceleration = 0.0, .friction = 0.05};
  p.command.profile.shape = loop::ReferenceShape::record;
  p.command.profile.record =
      std::make_shared<const loop::ReferenceRecord>(loop::ReferenceRecord{{0.0, 0.5}, {0.0, 1e-2}});
  p.command.targets = {0};
  p.command.hold = 2.0;
  std::int64_t farthest = 0;  // long after the end of the record
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& record) {
    if (record.t > 1.5) farthest = std::max(farthest, std::abs(record.error));
  };
  trial::run_trial(p, observers);
  EXPECT_LE(farthest, 1);
}

}  // namespace
}  // namespace zerocount::testing
