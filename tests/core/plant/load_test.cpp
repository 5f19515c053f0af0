// A second mass behind an elastic coupling: the linear plant by its matrix exponential, rest, and the rigid
// limit.
#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/theory/linear_loop.hpp"
#include "core/trial/machine.hpp"
#include "tests/core/plant/held_plant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::plant {
namespace {

using namespace testing;

motion::PlantParameters loaded(double inertia, double stiffness, double damping) {
  motion::PlantParameters plant;
  plant.load = {inertia, stiffness, damping};
  return plant;
}

friction::FrictionAlongRotor linear_spring() {
  friction::FrictionAlongRotor friction;
  friction.model = friction::FrictionModel::spring;
  friction.uniform.k2 = 1e-12;
  friction.uniform.breakaway = 1e6;
  return friction;
}

// (θ, ω, θ − θL, ω − ωL) under torques held over a sample: the plant that the margins of `check` use, too.
TEST(PlantWithALoad, MatchesTheMatrixExponentialOnALinearSpring) {
  std::mt19937_64 random(15);
  std::normal_distribution<double> torque(0.0, 0.02);
  for (const double stiffness : {50.0, 2000.0, 5e4}) {
    for (const bool at_load : {false, true}) {
      motion::PlantParameters parameters = loaded(3e-4, stiffness, 0.01);
      parameters.load.damping_to_ground = 0.02;
      parameters.load.encoder = at_load ? motion::EncoderPlace::load : motion::EncoderPlace::motor;
      const friction::FrictionAlongRotor friction = linear_spring();
      const theory::HeldPlant held = theory::hold_plant({friction.uniform.k1, parameters.presliding_damping},
                                                        parameters, 1.0, sample, {});
      ASSERT_EQ(held.A.rows(), 4);
      Eigen::Vector4d state = Eigen::Vector4d::Zero();
      Plant plant(parameters, friction, {}, machine_tolerance);
      for (int k = 0; k < 200; ++k) {
        const double u = torque(random);
        plant.advance(motion::constant_torque(u), sample);
        state = held.A * state + held.b * u;
        const PlantReading reading = plant.read();
        ASSERT_NEAR(at_load ? reading.load_theta : reading.theta, state[0], 1e-13) << stiffness << " " << k;
        ASSERT_NEAR(at_load ? reading.theta : reading.load_theta, state[0] + state[2], 1e-13)
            << stiffness << " " << k;
      }
    }
  }
}

// With the paper's friction: the oscillation dies away, and then creep alone moves rotor and load together.
TEST(PlantWithALoad, ComesToRestWithItsRotor) {
  PreslidingPlant plant(loaded(5.54e-4, 2000.0, 0.05), {}, {}, {1e-11 * count, 1e-8 * count});
  for (int k = 0; k < 2000; ++k) hold(plant, 0.01, sample);
  ASSERT_TRUE(plant.rest());
  EXPECT_EQ(plant.load()->twist, 0.0);
  EXPECT_EQ(plant.load()->omega, plant.omega());
  const double theta = plant.theta();
  PreslidingPlant alone({}, {}, {}, {1e-11 * count, 1e-8 * count});
  for (int k = 0; k < 2000; ++k) hold(alone, 0.01, sample);
  const double before = alone.theta();
  hold(plant, 0.01, 1.0);
  hold(alone, 0.01, 1.0);
  EXPECT_NEAR(plant.theta() - theta, alone.theta() - before, 1e-3 * (alone.theta() - before));
}

// The stiffer the coupling, the nearer the motion to that of one mass, through breakaways and re-sticks.
TEST(PlantWithALoad, IsOneMassIfTheCouplingIsStiff) {
  motion::PlantParameters one;
  one.inertia = 8.54e-4;
  const auto difference = [&](double stiffness) {
    PreslidingPlant two(loaded(3e-4, stiffness, 1.0), {}, {}, machine_tolerance);
    PreslidingPlant whole(one, {}, {}, machine_tolerance);
    double largest = 0.0;
    for (int k = 0; k < 60; ++k) {
      const double torque = k % 20 < 10 ? 0.4 : -0.4;
      hold(two, torque, sample);
      hold(whole, torque, sample);
      largest = std::max(largest, std::abs(two.theta() - whole.theta()));
    }
    EXPECT_GT(two.breakaways(), 0);
    return largest;
  };
  const double soft = difference(1e4);
  EXPECT_LT(difference(1e6), 0.05 * soft);
}

// At rest, and the motor's torque begins to rise or to fall: the rotor goes where the torque goes, whichever
// way its contact was loaded last, and mirrored torques move it to mirrored places.
TEST(PlantWithALoad, StartsFromRestTowardsAVaryingTorque) {
  const auto places = [](double last, double side) {
    std::vector<double> thetas;
    PreslidingPlant plant(loaded(3e-4, 2000.0, 0.05), {}, {.history = {last * side}}, machine_tolerance);
    motion::TorqueCourse torque{0.0, 0.05 * side, 2000.0};
    for (int k = 0; k < 20; ++k) {
      plant.advance(torque, sample);
      torque = motion::course_after(torque, sample);
      thetas.push_back(side * plant.theta());
    }
    return thetas;
  };
  for (const double last : {0.0, 0.05, 0.1, 0.15, 0.2, -0.05, -0.1, -0.15, -0.2}) {
    const std::vector<double> upwards = places(last, 1.0);
    EXPECT_GT(upwards.front(), 0.0) << last;
    EXPECT_EQ(upwards, places(last, -1.0)) << last;
  }
}

motion::PlantParameters with_gap(double gap) {
  motion::PlantParameters plant = loaded(3e-4, 2000.0, 0.0);
  plant.load.gap = gap;
  plant.presliding_damping = 0.0;
  return plant;
}

friction::FrictionAlongRotor of_model(friction::FrictionModel model) {
  friction::FrictionAlongRotor friction;
  friction.model = model;
  return friction;
}

// A free rotor, a gap that the load crosses many times, and an error of the gear: nothing dissipates.
TEST(CouplingWithAGap, ConservesEnergy) {
  const motion::PlantParameters parameters = with_gap(2e-4);
  Plant plant(parameters, of_model(friction::FrictionModel::none), {.velocity = 0.2}, machine_tolerance);
  const motion::LoadSide side{.error = {{1e-4, 40.0, 0.3}, {2e-5, 900.0, 1.0}}, .twist = 3e-5};
  plant.start_load(side);
  const auto energy = [&] {
    const PlantReading r = plant.read();
    const double twist = r.theta + motion::value(side.error, r.theta) - r.load_theta;
    const double stretch = std::max(std::abs(twist) - 1e-4, 0.0);
    return 0.5 * (parameters.inertia * r.omega * r.omega + 3e-4 * r.load_omega * r.load_omega +
                  2000.0 * stretch * stretch);
  };
  const double start = energy();
  double slowest = 1.0;
  for (int k = 0; k < 2000; ++k) {
    hold(plant, 0.0, sample);
    ASSERT_NEAR(energy(), start, 1e-10 * start) << k;
    slowest = std::min(slowest, plant.read().load_omega);
  }
  EXPECT_LT(slowest, 0.19) << "the masses exchange no momentum";
}

TEST(CouplingWithAGap, LeavesAFreeLoadItsVelocity) {
  Plant plant(with_gap(1e-2), of_model(friction::FrictionModel::none), {.velocity = 0.1}, machine_tolerance);
  for (int k = 0; k < 10; ++k) {
    hold(plant, 1e-3, sample);
    const PlantReading reading = plant.read();
    ASSERT_EQ(reading.load_omega, 0.1);
    ASSERT_NEAR(reading.load_theta, 0.1 * sample * (k + 1), 1e-15);
    ASSERT_GT(reading.omega, 0.1);
  }
}

// A load on the edge of the gap winds the coupling up under a constant torque, as a spring and a mass do; one
// in the middle falls to the edge first.
TEST(CouplingWithAGap, WindsUpUnderAConstantTorque) {
  const double gap = 2e-4, torque = 0.05, inertia = 3e-4, stiffness = 2000.0;
  for (const bool at_edge : {true, false}) {
    Plant plant(with_gap(gap), of_model(friction::FrictionModel::coulomb), {}, machine_tolerance);
    plant.start_load({.disturbance = {torque}, .twist = at_edge ? -0.5 * gap : 0.0});
    const double fall = at_edge ? 0.0 : std::sqrt(gap * inertia / torque);
    const double velocity = torque / inertia * fall;
    const double rate = std::sqrt(stiffness / inertia);
    for (int k = 1; k < 100; ++k) {
      hold(plant, 0.0, 1e-4);
      const double t = 1e-4 * k - fall;
      const double wound =
          torque / stiffness * (1.0 - std::cos(rate * t)) + velocity / rate * std::sin(rate * t);
      const double free_fall = 0.5 * torque / inertia * 1e-8 * k * k;
      if (t > 0.0 && wound < 0.0) break;  // back in the gap
      ASSERT_NEAR(plant.read().load_theta, t > 0.0 ? 0.5 * gap + wound : free_fall, 1e-14) << at_edge << k;
      ASSERT_EQ(plant.theta(), 0.0);
    }
  }
}

TEST(CouplingWithAGap, StartsAtTheLoadPositionGivenByErrorAndGap) {
  trial::TrialParameters p;
  p.plant = with_gap(3e-4);
  p.initial.gap = 0.25;
  p.initial.position = 0.7;
  p.load_side.error = {{.amplitude = 1e-4, .periods = 50.0, .phase = 0.2}};
  trial::Machine<Plant> machine(p);
  EXPECT_NEAR(machine.read(0).load_theta, 1e-4 * std::sin(50.0 * 0.7 + 0.2) - 0.25 * 3e-4, 1e-17);
}

}  // namespace
}  // namespace zerocount::plant
