// The control in one and in two phases, by examples. Its law for random parameters is judged in Python
// (judge_controller.py).
#include "core/loop/controller.hpp"

#include <cstdint>

#include <gtest/gtest.h>

#include "tests/support/draws.hpp"

namespace zerocount::loop {
namespace {

constexpr double lowest = -0.49;
constexpr double highest = 0.48;

TEST(Controller, WithoutACoarsePhaseNoErrorIsTooLarge) {
  Controller controller({.ki = 0.0}, {18.75}, 0.0, {{lowest, highest}});
  for (const std::int64_t count : {0LL, 2'000'000'000'000LL, -2'000'000'000'000LL}) {
    controller.update(0, {count, 0}, 0.0);
    EXPECT_EQ(controller.phase(), ControlPhase::fine);
  }
  EXPECT_EQ(controller.phase_changes(), 0);
}

TEST(Controller, HasACoarsePhaseWhereItCanBeEntered) {
  ControllerParameters p;
  EXPECT_FALSE(has_coarse_phase(p));
  p.coarse.coarse_beyond = 500.0;
  EXPECT_TRUE(has_coarse_phase(p));
}

/// Fine within 10 counts at rest for one sample, coarse beyond 50; no gains yet.
ControllerParameters two_phases() {
  ControllerParameters p;
  p.ki = 0.0;
  p.coarse = {.kp = 0.0, .ki = 0.0, .kd = 0.0};
  p.coarse.fine_within = 10.0;
  p.coarse.fine_rate = 1.0;
  p.coarse.fine_dwell = 0.0;
  p.coarse.coarse_beyond = 50.0;
  return p;
}

TEST(Controller, TorqueGoesThroughAChangeOfPhaseUnchanged) {
  // Nothing but what the new gains make of the present sample may be added, whatever the old ones did.
  testing::Draws draw(3);
  for (int i = 0; i < 200; ++i) {
    ControllerParameters p = two_phases();
    p.coarse.kp = draw.uniform(0.0, 1e-2);
    p.coarse.ki = draw.uniform(0.0, 1e-4);
    p.coarse.kd = draw.uniform(0.0, 1e-2);
    Controller controller(p, {18.75}, draw.uniform(lowest, highest), {{lowest, highest}});
    const double torque = draw.uniform(lowest, highest);
    controller.update(0, {100, 5}, 0.0);
    controller.update(0, {3, 0}, draw.uniform(lowest, highest));
    ASSERT_EQ(controller.phase(), ControlPhase::coarse);
    EXPECT_EQ(controller.update(0, {3, 0}, torque), torque);  // into a fine phase without gains
    ASSERT_EQ(controller.phase(), ControlPhase::fine);
    EXPECT_EQ(controller.integral(), torque);
    EXPECT_EQ(controller.update(0, {4, 0}, 0.0), torque) << "only at a change is the torque in force taken";
  }
}

TEST(Controller, ANewPhaseAddsWhatItsGainsMakeOfThisSampleAndTheOneBefore) {
  ControllerParameters p = two_phases();
  p.coarse.kp = 1.0 / 1024;
  p.coarse.ki = 1.0 / 65536;
  p.coarse.kd = 1.0 / 512;
  Controller controller(p, {18.75}, 0.0, {{lowest, highest}});
  controller.update(0, {40, 2}, 0.0);
  const double torque = controller.update(0, {60, 3}, 0.125);
  EXPECT_EQ(controller.phase(), ControlPhase::coarse);
  EXPECT_EQ(torque, 0.125 - 60.0 / 1024 - (60.0 + 40.0) / 65536 - 20.0 / 512);
}

TEST(Controller, APhaseFedBackFromTheCoarseEncoderKnowsThatOnesLastCount) {
  ControllerParameters p = two_phases();
  p.coarse.encoder = EncoderChoice::coarse;
  p.coarse.ki = 1.0 / 65536;
  p.coarse.kd = 1.0 / 512;
  Controller controller(p, {16.0}, 0.0, {{lowest, highest}});
  controller.update(0, {40, 2}, 0.0);
  const double torque = controller.update(0, {60, 4}, 0.125);
  EXPECT_EQ(torque, 0.125 - (64.0 + 32.0) / 65536 - 32.0 / 512);
}

TEST(Controller, IntegralOfANewPhaseStaysInTheRangeOfTheDac) {
  ControllerParameters p = two_phases();
  p.coarse.ki = 1e-3;
  for (const AntiWindup anti_windup : {AntiWindup::clamp, AntiWindup::none}) {
    p.anti_windup = anti_windup;
    Controller controller(p, {18.75}, 0.0, {{lowest, highest}});
    controller.update(0, {0, 0}, 0.0);
    const double torque = controller.update(0, {-100, -6}, highest);
    EXPECT_EQ(torque, anti_windup == AntiWindup::clamp ? highest : highest + 1e-3 * 100.0);
    EXPECT_EQ(controller.integral(), torque);
  }
}

TEST(Controller, FinePhaseOfTwoHasNoDerivativePart) {
  ControllerParameters p;
  p.ki = 0.0;
  p.kd = 1.0;
  Controller one_phase(p, {18.75}, 0.0, {{lowest, highest}});
  p.coarse.coarse_beyond = 50.0;
  Controller two(p, {18.75}, 0.0, {{lowest, highest}});
  for (Controller* controller : {&one_phase, &two}) controller->update(0, {0, 0}, 0.0);
  EXPECT_EQ(one_phase.update(0, {7, 0}, 0.0), -7.0);
  EXPECT_EQ(two.update(0, {7, 0}, 0.0), 0.0);
}

TEST(Controller, PresetIntegralIsThatOfThePhaseThatTheControlBeginsIn) {
  ControllerParameters p = two_phases();
  for (const std::int64_t count : {0, 1000}) {
    Controller controller(p, {18.75}, 0.25, {{lowest, highest}});
    EXPECT_EQ(controller.update(0, {count, 0}, 0.0), 0.25);
    EXPECT_EQ(controller.phase(), count == 0 ? ControlPhase::fine : ControlPhase::coarse);
    EXPECT_EQ(controller.phase_changes(), 0);
  }
}

TEST(Controller, APhaseSeesOnlyItsOwnEncoder) {
  testing::Draws draw(4);
  ControllerParameters p;
  p.kp = 1e-3;
  p.kd = 2e-3;
  p.coarse = {.kp = 1e-4, .ki = 1e-5, .kd = 1e-3, .encoder = EncoderChoice::coarse, .coarse_beyond = 50.0};
  for (const ControlPhase phase : {ControlPhase::fine, ControlPhase::coarse}) {
    Controller controller(p, {18.75}, 0.0, {{lowest, highest}});
    Controller other(p, {18.75}, 0.0, {{lowest, highest}});
    for (int k = 0; k < 500; ++k) {
      const bool fine = phase == ControlPhase::fine;
      const EncoderReading reading =
          fine ? EncoderReading{draw.integer(-50, 50), 0} : EncoderReading{60, draw.integer(7, 1000)};
      EncoderReading disturbed = reading;
      // At the first sample of a coarse phase the fine encoder was read, and it has to show the same.
      if (fine)
        disturbed.coarse = draw.integer(-1000, 1000);
      else if (k > 0)
        disturbed.fine = draw.integer(-1000, 1000);
      ASSERT_EQ(controller.update(0, reading, 0.1), other.update(0, disturbed, 0.1));
      ASSERT_EQ(other.phase(), phase);
    }
  }
}

}  // namespace
}  // namespace zerocount::loop
