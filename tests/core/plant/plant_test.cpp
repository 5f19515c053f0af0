// The rotor on its contact: closed forms where there are any, and invariants where there are not.
#include "core/plant/plant.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace zerocount {
namespace {

constexpr double count = 2.0 * std::numbers::pi / 1620000;  // rad
constexpr double sample = 5e-4;                             // s
constexpr MotionTolerance tolerance{1e-10 * count};

FrictionAlongRotor without_creep(FrictionParameters friction = {}) {
  friction.alpha = 0.0;
  return {friction, {}};
}

TEST(PlantOnALinearSpring, OscillatesAsTheClosedFormSays) {
  FrictionParameters friction;
  friction.k2 = 1e-12;
  friction.breakaway = 1e6;
  const PlantParameters rotor;
  Plant plant(rotor, without_creep(friction), 0.0, 0.0, 0.0, tolerance);
  const double u = 0.05;
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const double frequency = std::sqrt(friction.k1 / rotor.inertia - decay * decay);
  for (int k = 1; k <= 200; ++k) {
    plant.advance(u, sample);
    const double t = k * sample;
    const double exact = u / friction.k1 *
                         (1.0 - std::exp(-decay * t) *
                                    (std::cos(frequency * t) + decay / frequency * std::sin(frequency * t)));
    EXPECT_NEAR(plant.theta(), exact, 1e-8 * count) << k;
  }
}

TEST(PlantAtConstantTorque, EndsOnTheUnloadingLoopsAndStays) {
  Plant plant({}, without_creep(), 0.0, 0.0, 0.0, tolerance);
  for (int k = 0; k < 2000; ++k) plant.advance(0.02, sample);
  const double theta = plant.theta();
  const std::size_t depth = plant.spring().depth();
  EXPECT_NEAR(plant.spring().torque(), 0.02, 1e-9 * count * 860);
  EXPECT_EQ(plant.omega(), 0.0);
  for (int k = 0; k < 20000; ++k) plant.advance(0.02, sample);
  EXPECT_EQ(plant.theta(), theta);
  EXPECT_EQ(plant.spring().depth(), depth);
}

TEST(PlantAtConstantTorque, CreepsAsTheExactSolutionOnceTheSpringIsStill) {
  const FrictionParameters friction;
  Plant plant({}, {friction, {}}, 0.0, 0.0, 0.0, tolerance);
  const double u = 0.02;
  for (int k = 0; k < 400; ++k) plant.advance(u, sample);
  const CreepState start = plant.creep();
  const double torque_start = plant.spring().torque();
  for (int k = 0; k < 20000; ++k) plant.advance(u, sample);
  // The spring carries u − c·ω, with ω the creep rate: less than a thousandth of u. Bracket by the two
  // torques.
  const double slow = creep_at_constant_torque(friction, start, torque_start, 20000 * sample).extension;
  const double fast = creep_at_constant_torque(friction, start, u, 20000 * sample).extension;
  EXPECT_GE(plant.creep().extension, slow * (1 - 1e-12));
  EXPECT_LE(plant.creep().extension, fast * (1 + 1e-12));
  EXPECT_LT((fast - slow) / fast, 1e-2);
  for (int k = 0; k < 200000; ++k) plant.advance(u, sample);
  EXPECT_NEAR(plant.creep().extension, hardening_limit(friction, u), 1e-6 * count);
  EXPECT_NEAR(plant.spring().torque(), u, 1e-8 * count * 860);
}

TEST(Plant, MovesAlikeInOneStepOrInPieces) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    Plant whole({}, {{}, {}}, 0.0, 0.0, 0.0, tolerance);
    Plant pieces({}, {{}, {}}, 0.0, 0.0, 0.0, tolerance);
    for (int k = 0; k < 200; ++k) {
      const double u = 0.2 * (unit(random) - 0.5);
      whole.advance(u, sample);
      double left = sample;
      for (int piece = 0; piece < 6; ++piece) {
        const double part = left * unit(random);
        pieces.advance(u, part);
        left -= part;
      }
      pieces.advance(u, left);
      EXPECT_NEAR(whole.theta(), pieces.theta(), 1e-8 * count);
    }
  }
}

TEST(Plant, OppositeTorqueGivesTheOppositeMotionBitForBit) {
  std::mt19937 random(22);
  std::normal_distribution<double> torque(0.0, 0.4);
  Plant plant({}, {{}, {}}, 0.0, 0.0, 0.05, tolerance);
  Plant mirror({}, {{}, {}}, 0.0, 0.0, -0.05, tolerance);
  for (int k = 0; k < 3000; ++k) {
    const double u = torque(random);
    plant.advance(u, sample);
    mirror.advance(-u, sample);
    ASSERT_EQ(plant.theta(), -mirror.theta()) << k;
    ASSERT_EQ(plant.omega(), -mirror.omega()) << k;
  }
  EXPECT_GT(plant.breakaways(), 10);
}

/// Follows the plant in short steps and adds up the energy that damper and sliding friction take.
struct EnergyLedger {
  PlantParameters rotor;
  FrictionParameters friction;
  double work{0.0};        // by the torque, J
  double dissipated{0.0};  // by the dampers and sliding friction, J

  double loss_power(const Plant& plant) const {
    const double omega = plant.omega();
    if (!plant.sliding()) return rotor.presliding_damping * omega * omega;
    const double coulomb = friction.coulomb_ratio * friction.breakaway;
    const double r = omega / friction.stribeck_velocity;
    return std::abs(omega) * (coulomb + (friction.breakaway - coulomb) * std::exp(-r * r)) +
           rotor.sliding_damping * omega * omega;
  }

  void step(Plant& plant, double u, double dt) {
    const double theta = plant.theta();
    const double before = loss_power(plant);
    plant.advance(u, 0.5 * dt);
    const double middle = loss_power(plant);
    plant.advance(u, 0.5 * dt);
    dissipated += dt / 6.0 * (before + 4.0 * middle + loss_power(plant));  // Simpson
    work += u * (plant.theta() - theta);
  }
};

TEST(PlantThroughBreakawayAndReStick, BalancesItsEnergy) {
  // With k2 → 0 the spring is elastic: stored energy σ²/2k1, the same before a slide and after it because the
  // new contact carries the torque of the old one.
  EnergyLedger ledger;
  ledger.friction.k1 = 400.0;
  ledger.friction.k2 = 1e-9;
  ledger.friction.breakaway = 0.1;
  Plant plant(ledger.rotor, without_creep(ledger.friction), 0.0, 0.0, 0.0, tolerance);
  const auto stored = [&] {
    const double torque = plant.spring().torque();
    return 0.5 * torque * torque / ledger.friction.k1 +
           0.5 * ledger.rotor.inertia * plant.omega() * plant.omega();
  };
  double largest = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double u = (k / 20) % 2 == 0 ? 0.15 : -0.12;
    for (int i = 0; i < 250; ++i) ledger.step(plant, u, sample / 250);
    largest = std::max(largest, std::abs(ledger.work));
    EXPECT_NEAR(ledger.work, stored() + ledger.dissipated, 2e-5 * largest) << k;
  }
  EXPECT_GE(plant.breakaways(), 15);
}

TEST(PlantThroughBreakawayAndReStick, StartsANewContactWithTheTorqueOfTheOld) {
  Plant plant({}, {{}, {}}, 0.0, 0.0, 0.0, tolerance);
  while (!plant.sliding()) plant.advance(0.4, 1e-6);
  const double torque = plant.spring().torque();
  const double hook_torque = torque + 0.2 * plant.omega();
  EXPECT_NEAR(hook_torque, plant.contact().breakaway, 1e-3);
  double u = 0.4;
  for (int k = 0; k < 20; ++k) plant.advance(u, sample);
  EXPECT_TRUE(plant.sliding());
  const double theta = plant.theta();
  u = -0.1;
  while (plant.sliding()) plant.advance(u, 1e-7);
  EXPECT_GT(plant.theta(), theta);
  EXPECT_NEAR(plant.spring().torque(), torque, 1e-4);
  EXPECT_LT(std::abs(plant.creep().extension), 1e-8);
}

TEST(PlantOnAProfile, TakesTheParametersWhereItSticks) {
  const auto profile =
      std::make_shared<const Profile>(Profile{Marginal::normal, 100.0, 20.0, {0.0, 1.0}, {0.0, 0.5}});
  FrictionAlongRotor friction;
  friction.profiled.push_back({&FrictionParameters::k1, profile});
  const double start = 1.25;
  Plant plant({}, friction, start, 0.0, 0.0, tolerance);
  EXPECT_DOUBLE_EQ(plant.contact().k1, 100.0 + 20.0 * (std::cos(start) + 0.5 * std::sin(start)));
  const double before = plant.contact().k1;
  for (int k = 0; k < 100; ++k) plant.advance(0.45, sample);
  EXPECT_TRUE(plant.sliding());
  EXPECT_EQ(plant.contact().k1, before);
  while (plant.sliding()) plant.advance(-0.2, 1e-7);
  const double at = start + plant.theta();
  EXPECT_NEAR(plant.contact().k1, 100.0 + 20.0 * (std::cos(at) + 0.5 * std::sin(at)), 1e-3);
  EXPECT_NE(plant.contact().k1, before);
}

TEST(Plant, GivesUpLoudlyOnAMotionItCannotFollow) {
  PlantParameters rotor;
  rotor.inertia = 1e-200;
  Plant plant(rotor, {{}, {}}, 0.0, 0.0, 0.0, tolerance);
  plant.advance(0.1, sample);
  EXPECT_FALSE(plant.finite());
}

}  // namespace
}  // namespace zerocount
