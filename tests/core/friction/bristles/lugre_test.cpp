// The LuGre law against the experiments of Canudas de Wit, Olsson, Åström and Lischinsky, "A new model for
// control of systems with friction", IEEE Trans. Automatic Control 40 (1995), sections III and IV, with their
// parameters.
#include "core/plant/plant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::friction {
namespace {

using LuGrePlant = plant::PlantWith<LuGreFriction>;

constexpr double bristle_stiffness = 1e5;  // N/m
const double bristle_damping = std::sqrt(1e5);
constexpr double mass = 1.0;
constexpr double viscous_damping = 0.4;
constexpr double coulomb_level = 1.0;
constexpr double static_level = 1.5;
constexpr double stribeck_velocity = 1e-3;

LuGrePlant published(const motion::PlantStart& start = {}) {
  FrictionAlongRotor friction;
  friction.model = FrictionModel::lugre;
  friction.uniform.breakaway = static_level;
  friction.uniform.coulomb_ratio = coulomb_level / static_level;
  friction.uniform.stribeck_velocity = stribeck_velocity;
  friction.uniform.sigma0 = bristle_stiffness;
  friction.uniform.sigma1 = bristle_damping;
  return {{.inertia = mass, .sliding_damping = viscous_damping}, friction, start, {1e-15, 1e-12}};
}

double steady_friction(double velocity) {
  const double ratio = velocity / stribeck_velocity;
  return coulomb_level + (static_level - coulomb_level) * std::exp(-ratio * ratio) +
         viscous_damping * velocity;
}

/// F = σ0·z + σ1·dz/dt + σ2·ω of the plant's state.
double friction_force(const LuGrePlant& plant) {
  const double velocity = plant.omega();
  const double level = steady_friction(velocity) - viscous_damping * velocity;
  const double rate = velocity - bristle_stiffness * std::abs(velocity) * plant.deflection() / level;
  return bristle_stiffness * plant.deflection() + bristle_damping * rate + viscous_damping * velocity;
}

// dz/dt = 0 gives F(v) = sgn(v)·g(v) + σ2·v. On its falling part a constant force has no stable velocity, so
// a stiff velocity control holds the mass there.
TEST(LuGre, HasTheSteadyStateCurve) {
  for (const double velocity : {5e-4, -1e-3, 2e-3, 5e-3, -0.1, 0.5}) {
    LuGrePlant plant = published();
    for (int k = 0; k < 60000; ++k) {
      plant.advance(motion::constant_torque(1e4 * (velocity - plant.omega())), 1e-5);
    }
    const double steady = std::copysign(steady_friction(std::abs(plant.omega())), plant.omega());
    EXPECT_NEAR(friction_force(plant), steady, 1e-6) << velocity;
  }
}

// A force that rises at a constant rate, in small steps: the applied force at which the velocity reaches the
// Stribeck velocity.
double breakaway_force(double rate) {
  LuGrePlant plant = published();
  const double step = 1e-4 / std::max(rate, 2.0);
  double force = 0.0;
  for (std::int64_t k = 0; plant.omega() < stribeck_velocity; ++k) {
    force = rate * step * (static_cast<double>(k) + 0.5);
    plant.advance(motion::constant_torque(force), step);
  }
  return force;
}

TEST(LuGre, BreaksAwayAtASmallerForceTheFasterTheForceRises) {
  EXPECT_NEAR(breakaway_force(0.5), 1.476, 5e-4);
  EXPECT_NEAR(breakaway_force(2.0), 1.436, 5e-4);
  EXPECT_NEAR(breakaway_force(10.0), 1.307, 5e-4);
  EXPECT_NEAR(breakaway_force(20.0), 1.189, 5e-4);
}

struct Oscillation {
  double amplitude;
  double period;
};

/// Half of the range and the mean time between upward crossings of the middle, over the second half.
Oscillation oscillation_of(const std::vector<double>& values, double step) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  const auto [low, high] = std::minmax_element(begin, values.end());
  const double middle = 0.5 * (*low + *high);
  std::vector<double> crossings;
  for (auto v = begin + 1; v != values.end(); ++v) {
    if (*(v - 1) < middle && *v >= middle) crossings.push_back(static_cast<double>(v - begin) * step);
  }
  const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  return {0.5 * (*high - *low), period};
}

// A mass pulled by a spring of 2 N/m, whose end moves at 0.1 m/s: stick-slip.
TEST(LuGre, StickSlipsBehindASpring) {
  LuGrePlant plant = published();
  constexpr double step = 1e-3;
  std::vector<double> force;
  for (int k = 0; k < 60000; ++k) {
    const double pull = 2.0 * (0.1 * step * (k + 0.5) - plant.theta());
    plant.advance(motion::constant_torque(pull), step);
    force.push_back(pull);
  }
  EXPECT_NEAR(oscillation_of(force, step).period, 6.36, 0.01);
}

// A PID controller with the integral of a position that is to come to 1: hunting (their gains: v = 6, p = 3,
// i = 4).
TEST(LuGre, HuntsUnderIntegralControl) {
  LuGrePlant plant = published();
  constexpr double step = 1e-3;
  double integral = 0.0;
  std::vector<double> position;
  for (int k = 0; k < 300000; ++k) {
    const double error = 1.0 - plant.theta();
    integral += 4.0 * error * step;
    plant.advance(motion::constant_torque(3.0 * error + integral - 6.0 * plant.omega()), step);
    position.push_back(plant.theta());
  }
  const Oscillation hunting = oscillation_of(position, step);
  EXPECT_NEAR(hunting.amplitude, 0.0639, 2e-4);
  EXPECT_NEAR(hunting.period, 24.4, 0.1);
}

// Frictional lag: at a velocity that varies, friction is lower while it falls than while it rises.
TEST(LuGre, LagsBehindAVaryingVelocity) {
  LuGrePlant plant = published({.velocity = 2e-3, .sliding = true});
  constexpr double step = 1e-5;
  const double frequency = 25.0;  // rad/s
  double rising = 0.0;
  double falling = 0.0;
  for (int k = 0; k < 200000; ++k) {
    const double t = step * k;
    const double wanted = 2e-3 + 1e-3 * std::sin(frequency * t);
    const double before = plant.omega();
    plant.advance(motion::constant_torque(1e4 * (wanted - plant.omega()) + friction_force(plant)), step);
    const bool crosses = (before - 2e-3) * (plant.omega() - 2e-3) < 0.0;
    if (crosses && t > 1.0) (plant.omega() > before ? rising : falling) = friction_force(plant);
  }
  EXPECT_GT(rising, falling + 1e-3);
}

// A small oscillation dies away, and the rotor then stands where it is.
TEST(LuGre, ComesToRest) {
  LuGrePlant plant = published({.velocity = 1e-4});
  for (int k = 0; k < 100; ++k) plant.advance(motion::constant_torque(0.7), 1e-2);
  const double standing = plant.theta();
  EXPECT_EQ(plant.omega(), 0.0);
  EXPECT_EQ(plant.deflection(), 0.7 / bristle_stiffness);
  for (int k = 0; k < 100; ++k) plant.advance(motion::constant_torque(0.7), 1e-2);
  EXPECT_EQ(plant.theta(), standing);
}

// z approaches Fc/σ0 as 1 − exp(−x·σ0/Fc), whatever the velocity (Dahl's closed form).
TEST(Dahl, HasItsClosedFormOverTheTravel) {
  FrictionAlongRotor friction;
  friction.model = FrictionModel::dahl;
  friction.uniform.coulomb_ratio = 0.8;
  const double level = 0.8 * friction.uniform.breakaway;
  const double stiffness = friction.uniform.sigma0;
  for (const double velocity : {0.2, -3.0}) {
    plant::PlantWith<DahlFriction> plant({}, friction, {.velocity = velocity}, {4e-16, 4e-14});
    const double direction = std::copysign(1.0, velocity);
    for (int k = 1; k <= 200; ++k) {
      plant.advance(motion::constant_torque(direction * 0.5), 1e-5 * (1 + k % 7));
      const double expected =
          direction * level / stiffness * -std::expm1(-std::abs(plant.theta()) * stiffness / level);
      ASSERT_NEAR(plant.deflection(), expected, 1e-14);
      ASSERT_EQ(plant.sliding(), stiffness * std::abs(plant.deflection()) > 0.99 * level);
    }
    EXPECT_TRUE(plant.sliding());
  }
}

}  // namespace
}  // namespace zerocount::friction
