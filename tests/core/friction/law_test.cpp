// A friction law that only this test knows: the plant integrates it through the interface of all laws.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/plant/plant.hpp"
#include "tests/core/friction/spring_damper.hpp"

namespace zerocount::friction {
namespace {

static_assert(motion::SmoothMotion<SpringDamper> && FrictionLaw<SpringDamper>);

constexpr motion::PlantParameters rotor{.inertia = 5.54e-4, .presliding_damping = 0.05};
constexpr motion::MotionTolerance tolerance{4e-16, 4e-14};

/// θ of J·θ″ = u − k·θ − d·θ′ from θ = 0 and ω₀: U + e^(−γt)·(−U·cos νt + (ω₀ − γU)/ν·sin νt), U = u/k, γ =
/// d/2J, ν² = k/J − γ².
double closed_form(double torque, double velocity, double stiffness, double t) {
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const double frequency = std::sqrt(stiffness / rotor.inertia - decay * decay);
  const double end = torque / stiffness;
  return end + std::exp(-decay * t) * (-end * std::cos(frequency * t) +
                                       (velocity - decay * end) / frequency * std::sin(frequency * t));
}

TEST(ALawOfTheTests, MovesByItsClosedForm) {
  const FrictionAlongRotor friction{{.k1 = 110.0}, {}};
  for (const double velocity : {0.0, 0.3, -2.0}) {
    plant::PlantWith<SpringDamper> plant(rotor, friction, {.velocity = velocity}, tolerance);
    for (int k = 1; k <= 200; ++k) {
      plant.advance(motion::constant_torque(0.02), 5e-4);
      const double exact = closed_form(0.02, velocity, 110.0, k * 5e-4);
      ASSERT_NEAR(plant.theta(), exact, 1e-13) << velocity << " " << k;
    }
    EXPECT_TRUE(plant.finite());
  }
}

TEST(ALawOfTheTests, HasItsEventsLocatedInTime) {
  const FrictionAlongRotor friction{{.k1 = 110.0}, {}};
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const double half_period = std::numbers::pi / std::sqrt(110.0 / rotor.inertia - decay * decay);
  plant::PlantWith<SpringDamper> plant(rotor, friction, {}, tolerance);
  for (int turn = 1; turn <= 8; ++turn) {  // from rest, ω = 0 after every half period
    plant.advance(motion::constant_torque(0.02), (turn == 1 ? 0.5 : 1.0) * half_period);
    EXPECT_EQ(plant.turns(), turn - 1);
  }
}

// A torque that moves comes to the law by its series.
TEST(ALawOfTheTests, FollowsATorqueThatSettles) {
  const FrictionAlongRotor friction{{.k1 = 110.0}, {}};
  plant::PlantWith<SpringDamper> whole(rotor, friction, {}, tolerance);
  plant::PlantWith<SpringDamper> pieces(rotor, friction, {}, tolerance);
  const motion::TorqueCourse course{0.0, 0.03, 700.0};
  whole.advance(course, 0.1);
  for (int k = 0; k < 100; ++k) pieces.advance(motion::course_after(course, k * 1e-3), 1e-3);
  EXPECT_NEAR(whole.theta(), pieces.theta(), 1e-13);
  EXPECT_NEAR(whole.theta(), 0.03 / 110.0, 0.03 / 110.0 * 0.05);
}

}  // namespace
}  // namespace zerocount::friction
