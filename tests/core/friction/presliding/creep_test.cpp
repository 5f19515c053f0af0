// The plastic module: its exact solution at constant torque, and the rules of the paper's Fig. 6.
#include "core/friction/presliding/creep.hpp"

#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

constexpr double long_time = 1e3;  // s, many relaxation times

TEST(Creep, RelaxesExponentiallyToTheHardeningLimit) {
  const FrictionParameters friction;
  const double limit = hardening_limit(friction, 0.05);
  EXPECT_DOUBLE_EQ(limit, 0.05 * 0.05 / 10.0);
  for (const double t : {0.0, 0.1, 1.0, 5.0}) {
    const CreepState state = creep_at_constant_torque(friction, {}, 0.05, t);
    EXPECT_NEAR(state.hardening, limit * (1.0 - std::exp(-0.5 * t)), 1e-18);
    EXPECT_EQ(state.extension, state.hardening);
  }
}

TEST(Creep, IsTheSameInOneStepOrMany) {
  const FrictionParameters friction;
  CreepState state;
  for (int i = 0; i < 1000; ++i) state = creep_at_constant_torque(friction, state, -0.08, 0.003);
  EXPECT_NEAR(state.extension, creep_at_constant_torque(friction, {}, -0.08, 3.0).extension, 1e-17);
}

TEST(Creep, NeedsMoreTorqueThanItWasHardenedWith) {
  const FrictionParameters friction;
  const CreepState hardened = creep_at_constant_torque(friction, {}, 0.1, long_time);
  for (const double torque : {0.1, 0.05, 0.0, -0.05, -0.0999999}) {
    const CreepState after = creep_at_constant_torque(friction, hardened, torque, long_time);
    EXPECT_NEAR(after.extension, hardened.extension, 1e-12) << torque;  // unloading gives nothing back
  }
  EXPECT_GT(creep_at_constant_torque(friction, hardened, 0.12, long_time).extension, hardened.extension);
}

TEST(Creep, LargerTorqueTheOtherWayCreepsBackWhileHardeningOnlyGrows) {
  const FrictionParameters friction;
  const CreepState hardened = creep_at_constant_torque(friction, {}, 0.1, long_time);
  const CreepState back = creep_at_constant_torque(friction, hardened, -0.12, long_time);
  EXPECT_LT(back.extension, hardened.extension);
  EXPECT_NEAR(back.hardening, 0.12 * 0.12 / 10.0, 1e-12);
  EXPECT_NEAR(hardened.extension - back.extension, back.hardening - hardened.hardening, 1e-15);
}

TEST(Creep, OnsetTorqueInvertsTheHardeningLimit) {
  FrictionParameters friction;
  for (const double n : {1.0, 1.5, 2.0, 3.7}) {
    friction.n = n;
    EXPECT_NEAR(torque_of_limit(friction, hardening_limit(friction, -0.07)), 0.07, 1e-15);
  }
}

TEST(Creep, NeverSetsInWhereItsRateIsZero) {
  FrictionParameters friction;
  friction.alpha = 0.0;
  EXPECT_TRUE(std::isinf(creep_onset_torque(friction, 0.0)));
}

}  // namespace
}  // namespace zerocount::friction
