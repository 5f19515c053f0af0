// The rotor on its contact: closed forms where there are any, and invariants where there are not.
#include "core/plant/plant.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/core/plant/held_plant.hpp"

namespace zerocount::plant {
namespace {

using namespace testing;

friction::FrictionAlongRotor without_creep(friction::FrictionParameters friction = {}) {
  friction.alpha = 0.0;
  return {friction, {}};
}

TEST(PlantOnALinearSpring, OscillatesAsTheClosedFormSays) {
  friction::FrictionParameters friction;
  friction.k2 = 1e-12;
  friction.breakaway = 1e6;
  const motion::PlantParameters rotor;
  PreslidingPlant plant(rotor, without_creep(friction), {}, rig_tolerance);
  const double u = 0.05;
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const double frequency = std::sqrt(friction.k1 / rotor.inertia - decay * decay);
  for (int k = 1; k <= 200; ++k) {
    hold(plant, u, sample);
    const double t = k * sample;
    const double exact = u / friction.k1 *
                         (1.0 - std::exp(-decay * t) *
                                    (std::cos(frequency * t) + decay / frequency * std::sin(frequency * t)));
    EXPECT_NEAR(plant.theta(), exact, 1e-8 * count) << k;
  }
}

TEST(PlantAtConstantTorque, EndsOnTheUnloadingLoopsAndStays) {
  PreslidingPlant plant({}, without_creep(), {}, rig_tolerance);
  for (int k = 0; k < 2000; ++k) hold(plant, 0.02, sample);
  const double theta = plant.theta();
  const std::size_t depth = plant.spring().depth();
  EXPECT_NEAR(plant.spring().torque(), 0.02, 1e-9 * count * 860);
  EXPECT_EQ(plant.omega(), 0.0);
  for (int k = 0; k < 20000; ++k) hold(plant, 0.02, sample);
  EXPECT_EQ(plant.theta(), theta);
  EXPECT_EQ(plant.spring().depth(), depth);
}

TEST(PlantAtConstantTorque, CreepsAsTheExactSolutionOnceTheSpringIsStill) {
  const friction::FrictionParameters friction;
  PreslidingPlant plant({}, {friction, {}}, {}, rig_tolerance);
  const double u = 0.02;
  for (int k = 0; k < 400; ++k) hold(plant, u, sample);
  const friction::CreepState start = plant.creep();
  const double torque_start = plant.spring().torque();
  for (int k = 0; k < 20000; ++k) hold(plant, u, sample);
  // The spring carries u − c·ω, with ω the creep rate: less than a thousandth of u. Bracket by the two
  // torques.
  const double slow =
      friction::creep_at_constant_torque(friction, start, torque_start, 20000 * sample).extension;
  const double fast = friction::creep_at_constant_torque(friction, start, u, 20000 * sample).extension;
  EXPECT_GE(plant.creep().extension, slow * (1 - 1e-12));
  EXPECT_LE(plant.creep().extension, fast * (1 + 1e-12));
  EXPECT_LT((fast - slow) / fast, 1e-2);
  for (int k = 0; k < 200000; ++k) hold(plant, u, sample);
  EXPECT_NEAR(plant.creep().extension, friction::hardening_limit(friction, u), 1e-6 * count);
  EXPECT_NEAR(plant.spring().torque(), u, 1e-8 * count * 860);
}

TEST(Plant, MovesAlikeInOneStepOrInPieces) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    PreslidingPlant whole({}, {{}, {}}, {}, rig_tolerance);
    PreslidingPlant pieces({}, {{}, {}}, {}, rig_tolerance);
    for (int k = 0; k < 200; ++k) {
      const double u = 0.2 * (unit(random) - 0.5);
      hold(whole, u, sample);
      double left = sample;
      for (int piece = 0; piece < 6; ++piece) {
        const double part = left * unit(random);
        hold(pieces, u, part);
        left -= part;
      }
      hold(pieces, u, left);
      EXPECT_NEAR(whole.theta(), pieces.theta(), 1e-8 * count);
    }
  }
}

TEST(Plant, OppositeTorqueGivesTheOppositeMotionBitForBit) {
  std::mt19937 random(22);
  std::normal_distribution<double> torque(0.0, 0.4);
  PreslidingPlant plant({}, {{}, {}}, {.preload = 0.05}, rig_tolerance);
  PreslidingPlant mirror({}, {{}, {}}, {.preload = -0.05}, rig_tolerance);
  for (int k = 0; k < 3000; ++k) {
    const double u = torque(random);
    hold(plant, u, sample);
    hold(mirror, -u, sample);
    ASSERT_EQ(plant.theta(), -mirror.theta()) << k;
    ASSERT_EQ(plant.omega(), -mirror.omega()) << k;
  }
  EXPECT_GT(plant.breakaways(), 10);
}

TEST(PlantThroughBreakawayAndReStick, StartsANewContactWithTheTorqueOfTheOld) {
  PreslidingPlant plant({}, {{}, {}}, {}, rig_tolerance);
  while (!plant.sliding()) hold(plant, 0.4, 1e-6);
  const double torque = plant.spring().torque();
  const double hook_torque = torque + 0.2 * plant.omega();
  EXPECT_NEAR(hook_torque, plant.contact().breakaway, 1e-3);
  double u = 0.4;
  for (int k = 0; k < 20; ++k) hold(plant, u, sample);
  EXPECT_TRUE(plant.sliding());
  const double theta = plant.theta();
  u = -0.1;
  while (plant.sliding()) hold(plant, u, 1e-7);
  EXPECT_GT(plant.theta(), theta);
  EXPECT_NEAR(plant.spring().torque(), torque, 1e-4);
  EXPECT_LT(std::abs(plant.creep().extension), 1e-8);
}

TEST(PlantOnAProfile, TakesTheParametersWhereItSticks) {
  const auto profile = std::make_shared<const friction::Profile>(
      friction::Profile{friction::Marginal::normal, 100.0, 20.0, {0.0, 1.0}, {0.0, 0.5}});
  friction::FrictionAlongRotor friction;
  friction.profiled.push_back({&friction::FrictionParameters::k1, profile});
  const double start = 1.25;
  PreslidingPlant plant({}, friction, {.position = start}, rig_tolerance);
  EXPECT_DOUBLE_EQ(plant.contact().k1, 100.0 + 20.0 * (std::cos(start) + 0.5 * std::sin(start)));
  const double before = plant.contact().k1;
  for (int k = 0; k < 100; ++k) hold(plant, 0.45, sample);
  EXPECT_TRUE(plant.sliding());
  EXPECT_EQ(plant.contact().k1, before);
  while (plant.sliding()) hold(plant, -0.2, 1e-7);
  const double at = start + plant.theta();
  EXPECT_NEAR(plant.contact().k1, 100.0 + 20.0 * (std::cos(at) + 0.5 * std::sin(at)), 1e-3);
  EXPECT_NE(plant.contact().k1, before);
}

TEST(Plant, GivesUpLoudlyOnAMotionItCannotFollow) {
  motion::PlantParameters rotor;
  rotor.inertia = 1e-200;
  PreslidingPlant plant(rotor, {{}, {}}, {}, rig_tolerance);
  hold(plant, 0.1, sample);
  EXPECT_FALSE(plant.finite());
}

// Torque beyond any breakaway, until the hook slides, and none until it sticks again.
template <class AnyPlant>
void slide_once(AnyPlant& plant, double torque) {
  for (int k = 0; k < 1000 && !plant.sliding(); ++k) hold(plant, torque, sample);
  for (int k = 0; k < 100000 && plant.sliding(); ++k) hold(plant, 0.0, sample);
}

template <class Law>
void expect_next_contact_at_each_re_stick() {
  friction::FrictionAlongRotor friction{};
  friction.per_contact.push_back(
      {&friction::FrictionParameters::breakaway, [](std::uint64_t contact) {
         return 0.2 + 0.2 * friction::contact_uniform({.key = {1, 2}, .stream = 3}, 17, contact);
       }});
  PlantWith<Law> plant({}, friction, {}, rig_tolerance);
  EXPECT_EQ(plant.contact().breakaway, friction::FrictionParameters{}.breakaway);
  for (int contact = 1; contact <= 20; ++contact) {
    slide_once(plant, contact % 2 == 0 ? 0.5 : -0.5);
    ASSERT_EQ(plant.breakaways(), contact);
    const double u = random::open_uniform(random::random_bits_at({.key = {1, 2}, .stream = 3}, 17, contact));
    EXPECT_EQ(plant.contact().breakaway, 0.2 + 0.2 * u);
    EXPECT_EQ(plant.contact().k1, friction::FrictionParameters{}.k1);
  }
}

TEST(PlantWithContactsThatDiffer, HasTheNextContactAtEachReStick) {
  expect_next_contact_at_each_re_stick<friction::PreslidingFriction>();
  expect_next_contact_at_each_re_stick<friction::CoulombFriction>();
}

}  // namespace
}  // namespace zerocount::plant
