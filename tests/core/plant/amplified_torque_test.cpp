// The plant under the torque of a first-order amplifier: closed forms, limits, and the rest rule.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/plant/plant.hpp"
#include "tests/core/plant/held_plant.hpp"

namespace zerocount::plant {
namespace {

using namespace testing;

friction::FrictionAlongRotor spring_alone(friction::FrictionParameters friction = {}) {
  return {friction, {}, friction::FrictionModel::spring};
}

/// Random torques, followed by an amplifier from sample to sample.
class RandomTorques {
 public:
  RandomTorques(unsigned seed, double size, double rate) : random_(seed), torque_(0.0, size), rate_(rate) {}
  motion::TorqueCourse next() {
    const double now = motion::course_after(course_, sample).now;
    return course_ = {now, torque_(random_), rate_};
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> torque_;
  double rate_;
  motion::TorqueCourse course_{};
};

// J·x″ + c·x′ + k1·x = U·(1 − exp(−rt)), x = x′ = 0: a constant, an exponential and the two modes of the
// rotor.
TEST(PlantUnderAnAmplifier, MovesOnALinearSpringAsTheClosedFormSays) {
  friction::FrictionParameters friction;
  friction.k2 = 1e-12;
  friction.breakaway = 1e6;
  const motion::PlantParameters rotor;
  const double target = 0.05;
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const std::complex<double> mode{-decay, std::sqrt(friction.k1 / rotor.inertia - decay * decay)};
  for (const double rate : {3.0, 200.0, 5000.0, 1e5, 3e6}) {
    Plant plant(rotor, spring_alone(friction), {}, rig_tolerance);
    const double constant = target / friction.k1;
    const double lagging =
        -target / (rotor.inertia * rate * rate - rotor.presliding_damping * rate + friction.k1);
    // x = constant + lagging·exp(−rt) + Re(amplitude·exp(mode·t))
    const double real = -(constant + lagging);
    const std::complex<double> amplitude{real, (mode.real() * real - rate * lagging) / mode.imag()};
    motion::TorqueCourse course{0.0, target, rate};
    for (int k = 1; k <= 100; ++k) {
      plant.advance(course, sample);
      course = motion::course_after(course, sample);
      const double t = k * sample;
      const double exact = constant + lagging * std::exp(-rate * t) + (amplitude * std::exp(mode * t)).real();
      ASSERT_NEAR(plant.theta(), exact, 1e-7 * count) << rate << ' ' << k;
    }
  }
}

TEST(PlantUnderAnAmplifier, IsTheOneOfConstantTorqueWhereNothingIsLeftToFollow) {
  Plant amplified({}, {}, {}, rig_tolerance);
  Plant constant({}, {}, {}, rig_tolerance);
  std::mt19937 random(31);
  std::normal_distribution<double> torque(0.0, 0.3);
  for (int k = 0; k < 300; ++k) {
    const double u = torque(random);
    amplified.advance({u, u, 700.0}, sample);
    constant.advance(motion::constant_torque(u), sample);
    ASSERT_EQ(amplified.theta(), constant.theta());
  }
}

// It lags by 1/rate.
TEST(PlantUnderAnAmplifier, TendsToThatOfConstantTorqueWithItsBandwidth) {
  for (const friction::FrictionModel model :
       {friction::FrictionModel::presliding, friction::FrictionModel::spring,
        friction::FrictionModel::coulomb}) {
    double last = 0.0;
    for (const double rate : {1e6, 1e7, 1e8}) {
      friction::FrictionAlongRotor friction;
      friction.model = model;
      Plant amplified({}, friction, {}, rig_tolerance);
      Plant constant({}, friction, {}, rig_tolerance);
      double worst = 0.0;
      double now = 0.0;
      for (const double u : {0.2, -0.1, 0.45, 0.5, -0.2, 0.1}) {
        amplified.advance({now, u, rate}, sample);
        constant.advance(motion::constant_torque(u), sample);
        now = u;
        worst = std::max(worst, std::abs(amplified.theta() - constant.theta()));
      }
      EXPECT_GT(worst, 0.0);
      EXPECT_LT(worst, 2.0 / rate);  // at 2 rad/s
      if (last > 0.0) {
        EXPECT_NEAR(worst / last, 0.1, 0.02);
      }
      last = worst;
    }
  }
}

// 10¹² Hz, the highest bandwidth that the drive has: the torque is there in a picosecond.
TEST(PlantUnderAnAmplifier, CanBeFollowedUpToTheHighestBandwidth) {
  const double rate = 2.0 * std::numbers::pi * 1e12;
  for (const friction::FrictionModel model :
       {friction::FrictionModel::presliding, friction::FrictionModel::spring,
        friction::FrictionModel::coulomb}) {
    friction::FrictionAlongRotor friction;
    friction.model = model;
    Plant amplified({}, friction, {}, rig_tolerance);
    Plant constant({}, friction, {}, rig_tolerance);
    double now = 0.0;
    for (const double u : {0.2, -0.1, 0.45, 0.5, -0.2, 0.1}) {
      amplified.advance({now, u, rate}, sample);
      constant.advance(motion::constant_torque(u), sample);
      now = u;
      EXPECT_TRUE(amplified.finite());
      EXPECT_NEAR(amplified.theta(), constant.theta(), 2.0 / rate);
    }
  }
}

TEST(PlantUnderAnAmplifier, MovesAlikeInOneStepOrInPieces) {
  std::mt19937 random(32);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const friction::FrictionModel model :
       {friction::FrictionModel::presliding, friction::FrictionModel::spring,
        friction::FrictionModel::coulomb}) {
    for (unsigned trial = 0; trial < 10; ++trial) {
      friction::FrictionAlongRotor friction;
      friction.model = model;
      Plant whole({}, friction, {}, rig_tolerance);
      Plant pieces({}, friction, {}, rig_tolerance);
      RandomTorques torques(trial, model == friction::FrictionModel::coulomb ? 0.4 : 0.1,
                            std::pow(10.0, 2.0 + 3.0 * unit(random)));
      for (int k = 0; k < 200; ++k) {
        motion::TorqueCourse course = torques.next();
        whole.advance(course, sample);
        double left = sample;
        for (int piece = 0; piece < 6; ++piece) {
          const double part = piece < 5 ? left * unit(random) : left;
          pieces.advance(course, part);
          course = motion::course_after(course, part);
          left -= part;
        }
        ASSERT_NEAR(whole.theta(), pieces.theta(), 1e-7 * count) << k;
      }
      if (model == friction::FrictionModel::coulomb) {
        EXPECT_GT(whole.breakaways(), 1);
      }
    }
  }
}

TEST(PlantUnderAnAmplifier, OppositeTorqueGivesTheOppositeMotionBitForBit) {
  Plant plant({}, {}, {}, rig_tolerance);
  Plant mirror({}, {}, {}, rig_tolerance);
  RandomTorques torques(33, 0.4, 1500.0);
  for (int k = 0; k < 3000; ++k) {
    const motion::TorqueCourse course = torques.next();
    plant.advance(course, sample);
    mirror.advance({-course.now, -course.settled, course.rate}, sample);
    ASSERT_EQ(plant.theta(), -mirror.theta()) << k;
    ASSERT_EQ(plant.omega(), -mirror.omega()) << k;
  }
  EXPECT_GT(plant.breakaways(), 10);
}

// Loaded from virgin by a torque so slow that every sample changes it by less than the rest rule notices: the
// spring carries u − c·ω − J·dω/dt all the same, within the ε·(k1 + k2)/k1 that the rule promises.
TEST(PlantUnderAnAmplifier, FollowsATorqueTooSlowToBeNoticedAtOnce) {
  const friction::FrictionParameters friction;
  const motion::PlantParameters rotor;
  const double promised = rig_tolerance.elongation * (friction.k1 + friction.k2) / friction.k1;
  for (const double duration : {sample, 1.0, 200.0}) {  // in one step, or in many
    for (const double rate : {1e-8, 1e-6, 1e-4}) {
      PreslidingPlant plant(rotor, spring_alone(), {}, rig_tolerance);
      motion::TorqueCourse course{0.0, 0.02, rate};
      const double end = std::min(200.0, 20000 * duration);
      for (double t = 0.0; t < end - 0.5 * duration; t += duration) {
        plant.advance(course, duration);
        course = motion::course_after(course, duration);
      }
      const double change = rate * (course.settled - course.now);
      const double omega =
          change / friction::stiffness_on(plant.spring().branch(), plant.spring().elongation());
      const double carried = course.now - rotor.presliding_damping * omega;
      EXPECT_NEAR(plant.theta(), friction::virgin_elongation(friction, carried), 1.01 * promised)
          << duration << ' ' << rate;
      EXPECT_GT(plant.theta(), 0.0);
    }
  }
}

TEST(PlantUnderAnAmplifier, RestsOnceTheTorqueHasSettled) {
  for (const double rate : {50.0, 5000.0, 5e5}) {
    PreslidingPlant plant({}, spring_alone(), {}, rig_tolerance);
    motion::TorqueCourse course{0.0, 0.02, rate};
    for (int k = 0; k < 4000; ++k) {
      plant.advance(course, sample);
      course = motion::course_after(course, sample);
    }
    const double theta = plant.theta();
    EXPECT_NEAR(plant.spring().torque(), 0.02, 1e-9 * count * 860);
    EXPECT_EQ(plant.omega(), 0.0);
    for (int k = 0; k < 1000; ++k) {
      plant.advance(course, sample);
      course = motion::course_after(course, sample);
    }
    EXPECT_EQ(plant.theta(), theta);
  }
}

// u = U·(1 − exp(−rt)) in a slide without Stribeck and damping: J·ω = J·ω0 + ∫(u − F)dt.
TEST(PlantUnderAnAmplifier, SlidesAsTheClosedFormSays) {
  motion::PlantParameters rotor;
  rotor.sliding_damping = 0.0;
  friction::FrictionParameters friction;
  friction.coulomb_ratio = 1.0;
  const double torque = 0.5;
  for (const double rate : {10.0, 1000.0, 1e5, 1e7}) {
    Plant plant(rotor, {friction, {}}, {.velocity = 2.0, .sliding = true}, rig_tolerance);
    motion::TorqueCourse course{0.0, torque, rate};
    for (int k = 1; k <= 6; ++k) {
      plant.advance(course, sample);
      course = motion::course_after(course, sample);
      const double t = k * sample;
      const double lag = -std::expm1(-rate * t) / rate;  // ∫exp(−rt)dt
      const double omega = 2.0 + ((torque - friction.breakaway) * t - torque * lag) / rotor.inertia;
      const double theta =
          2.0 * t + (0.5 * (torque - friction.breakaway) * t * t - torque * (t - lag) / rate) / rotor.inertia;
      ASSERT_TRUE(plant.sliding());
      EXPECT_NEAR(plant.omega(), omega, 1e-10);
      EXPECT_NEAR(plant.theta(), theta, 1e-7 * count);
    }
  }
}

}  // namespace
}  // namespace zerocount::plant
