// What the plant finds at t = 0: a moving rotor, arrival from sliding, a history of the spring.
#include "core/motion/plant_start.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/plant/plant.hpp"
#include "tests/core/plant/held_plant.hpp"

namespace zerocount::plant {
namespace {

using namespace testing;

constexpr double damping = 0.2;    // N m s/rad, of PlantParameters
constexpr double breakaway = 0.3;  // N m, of FrictionParameters

TEST(PlantWithVelocity, RingsOnALinearSpringAsTheClosedFormSays) {
  friction::FrictionAlongRotor friction;
  friction.model = friction::FrictionModel::spring;
  friction.uniform.k2 = 1e-12;
  friction.uniform.breakaway = 1e6;
  const motion::PlantParameters rotor;
  const double velocity = -0.7;
  PreslidingPlant plant(rotor, friction, {.velocity = velocity}, rig_tolerance);
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const double frequency = std::sqrt(friction.uniform.k1 / rotor.inertia - decay * decay);
  EXPECT_EQ(plant.omega(), velocity);
  for (int k = 1; k <= 100; ++k) {
    hold(plant, 0.0, sample);
    const double t = k * sample;
    EXPECT_NEAR(plant.theta(), velocity / frequency * std::exp(-decay * t) * std::sin(frequency * t),
                1e-7 * count);
  }
}

TEST(PlantWithVelocity, BreaksAwayAtOnceWhereTheDamperOvercomesTheHook) {
  for (const double side : {1.0, -1.0}) {
    PreslidingPlant holding({}, {}, {.velocity = side * 0.99 * breakaway / damping}, rig_tolerance);
    hold(holding, 0.0, 1e-7);
    EXPECT_FALSE(holding.sliding());
    PreslidingPlant sliding({}, {}, {.velocity = side * 1.01 * breakaway / damping}, rig_tolerance);
    EXPECT_FALSE(sliding.sliding());
    hold(sliding, 0.0, 1e-7);
    EXPECT_TRUE(sliding.sliding());
    EXPECT_EQ(sliding.breakaways(), 1);
  }
}

// The spring of a preloaded contact carries nothing but rounding, of either sign. A contact that begins with
// that remembers no more than one that begins with nothing.
TEST(PlantWithVelocity, BreaksAwayFromAPreloadAsFromNone) {
  for (const double preload : {0.11, -0.11, 0.17, -0.17, 0.23}) {
    PreslidingPlant one({}, {}, {.velocity = 1.2 * breakaway / damping}, rig_tolerance);
    PreslidingPlant other({}, {}, {.preload = preload, .velocity = 1.2 * breakaway / damping}, rig_tolerance);
    for (int k = 0; k < 60; ++k) {
      hold(one, -0.05, sample);
      hold(other, -0.05, sample);
      ASSERT_EQ(one.theta(), other.theta()) << preload << ' ' << k;
      if (k > 0) {
        ASSERT_EQ(one.sliding() ? 0u : one.spring().depth(), other.sliding() ? 0u : other.spring().depth());
      }
    }
    EXPECT_FALSE(one.sliding());
    EXPECT_EQ(one.breakaways(), 1);
  }
}

TEST(PlantArrivingFromSliding, SlidesFromTheStartAndSticksWithTheBreakawayTorque) {
  for (const double side : {1.0, -1.0}) {
    motion::PlantStart start;
    start.velocity = side * 0.4;
    start.sliding = true;
    PreslidingPlant plant({}, {}, start, rig_tolerance);
    EXPECT_TRUE(plant.sliding());
    EXPECT_EQ(plant.theta(), 0.0);
    EXPECT_EQ(plant.omega(), start.velocity);
    EXPECT_EQ(plant.breakaways(), 0);
    while (plant.sliding()) hold(plant, side * 0.1, 1e-6);
    EXPECT_NEAR(plant.spring().torque(), side * breakaway, 1e-3);
    EXPECT_GT(side * plant.theta(), 0.0);
  }
}

// Without Stribeck the slide decelerates evenly; the contact it ends in carries σb.
TEST(PlantArrivingFromSliding, StopsWhereTheClosedFormSays) {
  motion::PlantParameters rotor;
  rotor.sliding_damping = 0.0;
  friction::FrictionAlongRotor friction;
  friction.uniform.coulomb_ratio = 1.0;
  PreslidingPlant plant(rotor, friction, {.velocity = 0.5, .sliding = true}, rig_tolerance);
  const double deceleration = (breakaway + 0.05) / rotor.inertia;
  const double stop = 0.5 / deceleration;
  hold(plant, -0.05, (1.0 - 1e-9) * stop);
  EXPECT_TRUE(plant.sliding());
  EXPECT_NEAR(plant.theta(), 0.25 * stop, 1e-15);
  hold(plant, -0.05, 2e-9 * stop);
  EXPECT_FALSE(plant.sliding());
  EXPECT_NEAR(plant.spring().torque(), breakaway, 1e-6);
}

TEST(PlantArrivingFromSliding, HasNoContactToRemember) {
  motion::PlantStart bare;
  bare.velocity = -0.8;
  bare.sliding = true;
  motion::PlantStart full = bare;
  full.hardening = 1e-5;
  full.preload = 0.1;
  full.history = {0.05, -0.02};
  PreslidingPlant one({}, {}, bare, rig_tolerance);
  PreslidingPlant other({}, {}, full, rig_tolerance);
  for (int k = 0; k < 50; ++k) {
    hold(one, 0.02, sample);
    hold(other, 0.02, sample);
    ASSERT_EQ(one.theta(), other.theta());
    ASSERT_EQ(one.creep().hardening, other.creep().hardening);
  }
}

TEST(PlantArrivingFromSliding, TakesTheBreakawayTorqueOfTheRotorAngle) {
  friction::FrictionAlongRotor friction;
  friction.profiled.push_back({&friction::FrictionParameters::breakaway,
                               std::make_shared<const friction::Profile>(friction::Profile{
                                   friction::Marginal::normal, 0.2, 0.05, {0.0, 1.0}, {0.0, 0.5}})});
  const double angle = 1.25;
  PreslidingPlant plant({}, friction, {.position = angle, .velocity = 0.3, .sliding = true}, rig_tolerance);
  const double level = 0.2 + 0.05 * (std::cos(angle) + 0.5 * std::sin(angle));
  EXPECT_DOUBLE_EQ(plant.contact().breakaway, level);
  while (plant.sliding()) hold(plant, 0.0, 1e-7);
  EXPECT_NEAR(plant.spring().torque(), level, 1e-5);
}

TEST(PlantWithHistory, StandsAtZeroWithoutTorque) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> torque(-0.25, 0.25);
  for (int trial = 0; trial < 50; ++trial) {
    motion::PlantStart start;
    start.preload = trial % 3 == 0 ? 0.0 : torque(random);
    start.hardening = trial % 2 == 0 ? 0.0 : 1e-6;
    for (int i = 0; i <= trial; ++i) start.history.push_back(torque(random));
    PreslidingPlant plant({}, {}, start, rig_tolerance);
    EXPECT_EQ(plant.theta(), 0.0);
    EXPECT_NEAR(plant.spring().torque(), 0.0, 1e-15);
    EXPECT_EQ(plant.creep().extension, 0.0);
    EXPECT_EQ(plant.creep().hardening, start.hardening);
    EXPECT_EQ(plant.deepest(), static_cast<std::int64_t>(plant.spring().depth()));
    for (int k = 0; k < 100; ++k) hold(plant, 0.0, sample);
    EXPECT_EQ(plant.theta(), 0.0);
    EXPECT_EQ(plant.omega(), 0.0);
  }
}

TEST(PlantWithHistory, IsThePreloadedOneWhereThePreloadIsItsOnlyLevel) {
  PreslidingPlant preloaded({}, {}, {.preload = -0.12}, rig_tolerance);
  motion::PlantStart start;
  start.history = {-0.12};
  PreslidingPlant loaded({}, {}, start, rig_tolerance);
  EXPECT_EQ(loaded.spring().depth(), preloaded.spring().depth());
  EXPECT_NEAR(loaded.spring().elongation(), preloaded.spring().elongation(), 1e-19);
  for (int k = 0; k < 200; ++k) {
    hold(preloaded, 0.05 * std::sin(0.3 * k), sample);
    hold(loaded, 0.05 * std::sin(0.3 * k), sample);
    EXPECT_NEAR(loaded.theta(), preloaded.theta(), 1e-9 * count);
  }
}

TEST(PlantWithHistory, ForgetsWhatALargerTorqueHasWipedOut) {
  motion::PlantStart plain;
  plain.history = {0.2, -0.1, 0.06};
  motion::PlantStart full;
  full.history = {0.05, -0.1, 0.03, 0.2, 0.1, 0.15, -0.1, -0.02, -0.06, 0.06, -0.01, 0.02};
  PreslidingPlant one({}, {}, plain, rig_tolerance);
  PreslidingPlant other({}, {}, full, rig_tolerance);
  EXPECT_EQ(one.spring().depth(), 3u);
  EXPECT_EQ(other.spring().depth(), 5u);  // and, inside, the last two
  full.history.resize(10);
  EXPECT_EQ(PreslidingPlant({}, {}, full, rig_tolerance).spring().depth(), 3u);
  for (int k = 0; k < 100; ++k) {
    hold(one, -0.15, sample);
    hold(other, -0.15, sample);
  }
  EXPECT_NEAR(one.spring().torque(), other.spring().torque(), 1e-9);
}

TEST(PlantWithHistory, HoldsAnyNumberOfReversals) {
  motion::PlantStart start;
  constexpr int reversals = 100000;
  for (int i = 0; i < reversals; ++i) {
    start.history.push_back((i % 2 == 0 ? 0.25 : -0.25) * (1.0 - static_cast<double>(i) / reversals));
  }
  PreslidingPlant plant({}, {}, start, rig_tolerance);
  EXPECT_EQ(plant.spring().depth(), static_cast<std::size_t>(reversals));
  EXPECT_NEAR(plant.spring().torque(), 0.0, 1e-15);
  plant.advance({0.0, 0.28, 20.0}, 1.0);
  EXPECT_LT(plant.spring().depth(), 10u);
  EXPECT_TRUE(plant.finite());
}

TEST(PlantWithHistory, MirrorsBitForBit) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> torque(-0.2, 0.2);
  for (int trial = 0; trial < 20; ++trial) {
    motion::PlantStart start;
    motion::PlantStart mirrored;
    start.preload = torque(random);
    start.velocity = torque(random);
    for (int i = 0; i < 9; ++i) start.history.push_back(torque(random));
    mirrored.preload = -start.preload;
    mirrored.velocity = -start.velocity;
    for (const double level : start.history) mirrored.history.push_back(-level);
    PreslidingPlant plant({}, {}, start, rig_tolerance);
    PreslidingPlant mirror({}, {}, mirrored, rig_tolerance);
    for (int k = 0; k < 100; ++k) {
      const motion::TorqueCourse course{torque(random), 3.0 * torque(random), 2000.0};
      plant.advance(course, sample);
      mirror.advance({-course.now, -course.settled, course.rate}, sample);
      ASSERT_EQ(plant.theta(), -mirror.theta());
      ASSERT_EQ(plant.omega(), -mirror.omega());
    }
  }
}

TEST(PlantOnASpringAlone, IsThePreslidingOneWithoutCreepBitForBit) {
  friction::FrictionAlongRotor spring;
  spring.model = friction::FrictionModel::spring;
  friction::FrictionAlongRotor presliding;
  presliding.uniform.alpha = 0.0;
  const motion::PlantStart start{.hardening = 3e-6, .preload = 0.1, .velocity = 0.2};
  PreslidingPlant one({}, spring, start, rig_tolerance);
  PreslidingPlant other({}, presliding, start, rig_tolerance);
  std::mt19937 random(13);
  std::normal_distribution<double> torque(0.0, 0.6);
  for (int k = 0; k < 500; ++k) {
    const double u = torque(random);
    hold(one, u, sample);
    hold(other, u, sample);
    ASSERT_EQ(one.theta(), other.theta());
    ASSERT_EQ(one.creep().extension, 0.0);
  }
  EXPECT_GT(one.breakaways(), 3);  // creep stays off at every new contact
}

}  // namespace
}  // namespace zerocount::plant
