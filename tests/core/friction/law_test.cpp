// A friction law that only this test knows: the plant integrates it through the interface of all laws.
#include "core/friction/profile.hpp"
#include "core/plant/plant.hpp"
#include "tests/core/friction/spring_damper.hpp"
#include "tests/support/test.hpp"

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

TEST(AddedFrictionLaw, MovesByItsClosedForm) {
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

TEST(AddedFrictionLaw, ItsEventsAreLocatedInTime) {
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
TEST(AddedFrictionLaw, FollowsATorqueThatSettles) {
  const FrictionAlongRotor friction{{.k1 = 110.0}, {}};
  plant::PlantWith<SpringDamper> whole(rotor, friction, {}, tolerance);
  plant::PlantWith<SpringDamper> pieces(rotor, friction, {}, tolerance);
  const motion::TorqueCourse course{0.0, 0.03, 700.0};
  whole.advance(course, 0.1);
  for (int k = 0; k < 100; ++k) pieces.advance(motion::course_after(course, k * 1e-3), 1e-3);
  EXPECT_NEAR(whole.theta(), pieces.theta(), 1e-13);
  EXPECT_NEAR(whole.theta(), 0.03 / 110.0, 0.03 / 110.0 * 0.05);
}

// The extremes of a profile, against a dense scan of it.

/// A profile of `waves` harmonics with normal coefficients, of which each is 0 with a probability of 1/2, so
/// that no symmetry is common to all.
Profile random_profile(std::mt19937_64& numbers, std::size_t waves) {
  std::normal_distribution<double> normal;
  std::bernoulli_distribution is_there(0.5);
  Profile profile{.marginal = is_there(numbers) ? Marginal::normal : Marginal::lognormal,
                  .location = 1.0,
                  .scale = 0.3,
                  .cosine = {},
                  .sine = {},
                  .period = is_there(numbers) ? 0.25 : 6.283185307179586};
  for (std::size_t m = 0; m <= waves; ++m) {
    profile.cosine.push_back(is_there(numbers) ? normal(numbers) : 0.0);
    profile.sine.push_back(is_there(numbers) ? normal(numbers) : 0.0);
  }
  return profile;
}

TEST(ProfileRange, HasTheExtremesOfADenseScan) {
  std::mt19937_64 numbers(20020721);
  for (int i = 0; i < 200; ++i) {
    const std::size_t waves = 1 + static_cast<std::size_t>(i) % 40;
    const Profile profile = random_profile(numbers, waves);
    const std::size_t count = 400 * (waves + 1);
    double low = value_at(profile, 0.0), high = low;
    for (std::size_t k = 1; k < count; ++k) {
      const double value =
          value_at(profile, profile.period * static_cast<double>(k) / static_cast<double>(count));
      low = std::min(low, value);
      high = std::max(high, value);
    }
    const ValueRange range = range_over_revolution(profile);
    const double tolerance = 5e-3 * (high - low) + 1e-12;  // of the scan, and of nearly equal extremes
    EXPECT_NEAR(range.low, low, tolerance) << waves << " waves, profile " << i;
    EXPECT_NEAR(range.high, high, tolerance) << waves << " waves, profile " << i;
    EXPECT_EQ(lowest_over_revolution(profile), range.low);
  }
}

}  // namespace
}  // namespace zerocount::friction
