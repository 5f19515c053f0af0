#include "core/theory/stability.hpp"

#include <Eigen/Dense>

#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/move_times.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/theory/analogue_controller.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/support/test.hpp"

namespace zerocount::theory {
namespace {

// The defaults of these structs are the paper's machine.
const motion::PlantParameters plant;
const friction::FrictionParameters contact;
const loop::EncoderParameters encoder;
const loop::ControllerParameters integral_only;

/// Expects that the value agrees with the printed number of the paper (or of the text quoting it) to half a
/// unit of its last digit.
void expect_as_printed(double value, double printed, double last_digit) {
  EXPECT_NEAR(value, printed, 0.5 * last_digit);
}

loop::ControllerParameters with_kp(double kp) {
  loop::ControllerParameters controller;
  controller.kp = kp;
  return controller;
}

TEST(Gains, AnalogueGainsOfThePaperArePrintedAsTorquePerCount) {
  // Section 4 of the paper: c·k1/J = 0.15 and c·(k1 + k2)/J = 1.2 N m/(count s), which are 3.85e-5
  // and 3.01e-4 N m/count.
  const double lower = plant.presliding_damping * contact.k1 / plant.inertia;
  const double upper = plant.presliding_damping * (contact.k1 + contact.k2) / plant.inertia;
  expect_as_printed(lower * loop::fine_resolution(encoder), 0.15, 0.01);
  expect_as_printed(upper * loop::fine_resolution(encoder), 1.2, 0.1);
  expect_as_printed(with_analogue_gains({}, {0.0, lower, 0.0}, encoder).ki, 3.85e-5, 1e-7);
  expect_as_printed(with_analogue_gains({}, {0.0, upper, 0.0}, encoder).ki, 3.01e-4, 1e-6);
}

TEST(Gains, ConversionsAreInverse) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> gain(0.0, 1e-3), rate(100.0, 2e4), counts(1e4, 1e7);
  for (int i = 0; i < 200; ++i) {
    loop::ControllerParameters controller;
    controller.sample_rate = rate(random);
    controller.kp = gain(random);
    controller.ki = gain(random);
    controller.kd = gain(random);
    loop::EncoderParameters scale;
    scale.fine = std::round(counts(random));
    const loop::ControllerParameters back =
        with_analogue_gains(controller, analogue_gains(controller, scale), scale);
    EXPECT_NEAR(back.kp, controller.kp, 1e-14 * controller.kp);
    EXPECT_NEAR(back.ki, controller.ki, 1e-14 * controller.ki);
    EXPECT_NEAR(back.kd, controller.kd, 1e-14 * controller.kd);
    EXPECT_EQ(back.sample_rate, controller.sample_rate);
  }
}

TEST(Gains, SampledControllerApproachesTheContinuousOneOnAMovingError) {
  // e(t) = sin 2t rad, sampled finely: the sampled law with converted gains must give u = kP·e + kI·∫e +
  // kD·e˙.
  const AnalogueGains gains{3.0, 7.0, 0.5};
  loop::ControllerParameters controller;
  controller.sample_rate = 1e5;
  controller = with_analogue_gains(controller, gains, encoder);
  const double dx = loop::fine_resolution(encoder);
  const auto error = [&](int k) { return k < 0 ? 0.0 : std::sin(2.0 * k / controller.sample_rate) / dx; };
  double integral = 0.0;
  const int samples = 100000;
  for (int k = 0; k <= samples; ++k) integral += controller.ki * (error(k) + error(k - 1));
  const double sampled =
      integral + controller.kp * error(samples) + controller.kd * (error(samples) - error(samples - 1));
  const double continuous =
      3.0 * std::sin(2.0) + 7.0 * (1.0 - std::cos(2.0)) / 2.0 + 0.5 * 2.0 * std::cos(2.0);
  EXPECT_NEAR(sampled, continuous, 1e-4);
}

TEST(Criteria, BoundsMatchThePaper) {
  const IntegralGainBounds bounds = integral_gain_bounds(plant, contact, encoder, integral_only);
  expect_as_printed(bounds.stable_below, 3.85e-5, 1e-7);
  expect_as_printed(bounds.unstable_above, 3.01e-4, 1e-6);
}

TEST(Criteria, ProportionalGainOfThePaperPutsItsIntegralGainOnTheLowerBound) {
  const IntegralGainBounds bounds = integral_gain_bounds(plant, contact, encoder, with_kp(6.21e-4));
  // Both printed numbers are rounded, 6.21e-4 by up to 1e-7 of the result.
  EXPECT_NEAR(bounds.stable_below, 9.45e-5, 1e-7);
}

TEST(Criteria, CriticalGainPutsThePolesOfTheContinuousLoopOnTheImaginaryAxis) {
  // Outside judge: the eigenvalues of the continuous loop's companion matrix, with every gain present.
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> factor(0.3, 3.0);
  for (int i = 0; i < 200; ++i) {
    motion::PlantParameters rotor;
    rotor.inertia *= factor(random);
    rotor.presliding_damping *= factor(random);
    loop::ControllerParameters controller;
    controller.kp = 5e-4 * factor(random);
    controller.kd = 1e-3 * factor(random);
    const double stiffness = 300.0 * factor(random);
    controller.ki = critical_integral_gain(stiffness, rotor, encoder, controller);

    const AnalogueGains gains = analogue_gains(controller, encoder);
    Eigen::Matrix3d companion = Eigen::Matrix3d::Zero();
    companion(0, 1) = companion(1, 2) = 1.0;
    companion.row(2) << -gains.ki, -(stiffness + gains.kp), -(rotor.presliding_damping + gains.kd);
    companion.row(2) /= rotor.inertia;
    const Eigen::Vector3cd poles = companion.eigenvalues();
    EXPECT_NEAR(poles.real().maxCoeff() / poles.cwiseAbs().maxCoeff(), 0.0, 1e-9);
  }
}

TEST(Rules, DacStepMatchesThePaper) {
  expect_as_printed(dac_resolution_bound(contact.k1, encoder), 4.27e-4, 1e-6);
  EXPECT_LT(loop::DacParameters{}.resolution, dac_resolution_bound(contact.k1, encoder));
}

// The coarse encoder has 18.75 times the count.
TEST(Rules, DacStepUsesTheCoarseEncoderIfItIsFedBack) {
  EXPECT_DOUBLE_EQ(dac_resolution_bound(contact.k1, encoder, loop::EncoderChoice::coarse),
                   18.75 * dac_resolution_bound(contact.k1, encoder));
}

TEST(Rules, NaturalFrequencyAndSampleRateMatchThePaper) {
  expect_as_printed(natural_frequency(contact.k1 + contact.k2, plant), 198.0, 1.0);
  EXPECT_NEAR(advised_sample_rate(plant, contact), 1983.0, 1.0);
  EXPECT_GT(integral_only.sample_rate, advised_sample_rate(plant, contact));
}

TEST(Rules, LowestStiffnessOfAUniformContactIsItsStiffness) {
  EXPECT_EQ(lowest_k1({}), 110.0);
}

TEST(Rules, LowestStiffnessOfASingleHarmonicIsItsTrough) {
  friction::Profile profile{
      friction::Marginal::normal, 100.0, 10.0, {0.0, 0.0, 0.0, 0.6}, {0.0, 0.0, 0.0, 0.8}};
  friction::FrictionAlongRotor friction;
  friction.profiled.push_back(
      {&friction::FrictionParameters::k1, std::make_shared<friction::Profile>(profile)});
  EXPECT_NEAR(lowest_k1(friction), 90.0, 1e-9);  // amplitude √(0.6² + 0.8²) = 1

  profile.marginal = friction::Marginal::lognormal;
  profile.location = std::log(100.0);
  profile.scale = 0.1;
  friction.profiled.front().profile = std::make_shared<friction::Profile>(profile);
  EXPECT_NEAR(lowest_k1(friction), 100.0 * std::exp(-0.1), 1e-9);
}

TEST(Rules, NoAngleHasALowerStiffnessThanTheLowest) {
  std::mt19937_64 random(13);
  std::normal_distribution<double> coefficient;
  std::uniform_real_distribution<double> angle(0.0, 2.0 * std::numbers::pi);
  for (int i = 0; i < 20; ++i) {
    friction::Profile profile{friction::Marginal::lognormal, std::log(110.0), 0.1, {}, {}};
    for (int m = 0; m < 30; ++m) {
      profile.cosine.push_back(coefficient(random) / 5.0);
      profile.sine.push_back(coefficient(random) / 5.0);
    }
    friction::FrictionAlongRotor friction;
    friction.profiled.push_back(
        {&friction::FrictionParameters::k1, std::make_shared<friction::Profile>(profile)});
    const double lowest = lowest_k1(friction);
    EXPECT_EQ(lowest, friction::range_over_revolution(profile).low);
    double seen = 1e9;
    for (int j = 0; j < 20000; ++j) seen = std::min(seen, friction::value_at(profile, angle(random)));
    EXPECT_GE(seen, lowest * (1.0 - 1e-6));
    EXPECT_LE(seen, lowest * (1.0 + 1e-3));
  }
}

// A slow integral control: the time that it takes to its target, against closed forms and trials.

trial::TrialParameters slow_machine(double ki, double kp = 0.0) {
  trial::TrialParameters p;
  p.controller.ki = ki;
  p.controller.kp = kp;
  return p;
}

TEST(SlowApproach, HasTheTimeConstantOfTheSampledLoop) {
  for (const double kp : {0.0, 3.0e-4, 2.0e-3}) {
    for (const double stiffness : {110.0, 400.0, 860.0}) {
      const trial::TrialParameters p = slow_machine(1.0e-7, kp);
      const double sampled = slowest_time_constant(stiffness, p.plant, p.encoder, p.controller);
      EXPECT_NEAR(slow_time_constant(stiffness, p.encoder, p.controller), sampled, 0.01 * sampled)
          << kp << " " << stiffness;
    }
  }
}

TEST(SlowApproach, IsAnExponentialForALinearSpring) {
  const trial::TrialParameters p = slow_machine(1.0e-6);
  friction::FrictionParameters contact;
  const auto exponential = [&](double stiffness, double step) {
    return slow_time_constant(stiffness, p.encoder, p.controller) * std::log(2.0 * step);
  };
  for (const std::int64_t step : {1, 2, 30, 405'000}) {
    const auto counts = static_cast<double>(step);
    contact.beta = 1.0e-9;
    const double stiff = slow_arrival_time(step, contact, p.encoder, p.controller);
    EXPECT_NEAR(stiff, exponential(contact.k1 + contact.k2, counts), 1e-6 * stiff);
    contact.beta = 1.0e12;
    const double soft = slow_arrival_time(step, contact, p.encoder, p.controller);
    EXPECT_NEAR(soft, exponential(contact.k1, counts), 0.2 * soft);  // but for the moment of the reversal
    contact.beta = 1.0e5;
    const double softening = slow_arrival_time(step, contact, p.encoder, p.controller);
    EXPECT_GE(softening, soft);
    EXPECT_LT(softening, stiff);
  }
}

// Moves of the paper's machine that reverse the motion, as the formula supposes.
TEST(SlowApproach, PredictsTheArrivalTimeOfTrials) {
  for (const double ki : {2.0e-7, 1.0e-6}) {
    for (const std::int64_t step : {2, 5, 12, 30}) {
      trial::TrialParameters p = slow_machine(ki);
      p.friction.uniform.alpha = 0.0;
      const double expected = slow_arrival_time(step, p.friction.uniform, p.encoder, p.controller);
      p.command.targets = {60, 60 - step};
      p.command.hold = 20.0 * slow_time_constant(860.0, p.encoder, p.controller);
      const double time = trial::run_trial(p).moves[1].arrival_time;
      EXPECT_GT(expected, 0.7 * time) << ki << " " << step;
      EXPECT_LT(expected, 1.5 * time) << ki << " " << step;
    }
  }
}

TEST(ChatterTime, IsTheTimeInWhichTheIntegralReplacesTheProportionalTorque) {
  const trial::TrialParameters p = slow_machine(1.0e-6, 1.0e-3);
  const friction::FrictionParameters& contact = p.friction.uniform;
  const double decay = 1.0e-3 / (2.0 * 1.0e-6 * 2000.0);
  const double frequency = 198.3;  // Hz, of the paper's machine
  EXPECT_NEAR(chatter_time(p.plant, contact, p.controller, 0.05), decay * std::log(frequency * 0.05),
              1e-3 * decay);
  EXPECT_EQ(chatter_time(p.plant, contact, p.controller, 0.001), 0.0);
  EXPECT_EQ(chatter_time(p.plant, contact, slow_machine(1.0e-6).controller, 0.05), 0.0);
}

// The shortest move under bounded torque, against closed forms and a stepwise integration.

TEST(ShortestMove, WithoutDampingIsTwoParabolas) {
  testing::RandomBlocks draw(3);
  for (int i = 0; i < 100; ++i) {
    const DrivenAxis axis{draw.log_uniform(1e-9, 1e7), 0.0, draw.log_uniform(1e-6, 1e6), 1.0};
    const double distance = draw.log_uniform(1e-9, 10.0);
    const DrivenAxis even{axis.inertia, 0.0, axis.driving, axis.driving};
    const double time = 2.0 * std::sqrt(distance * axis.inertia / axis.driving);
    EXPECT_NEAR(shortest_move(even, distance) / time, 1.0, 1e-4);
    const double uneven =
        std::sqrt(2.0 * distance * axis.inertia * (1.0 / axis.driving + 1.0 / axis.braking));
    EXPECT_NEAR(shortest_move(axis, distance) / uneven, 1.0, 1e-4);
  }
}

TEST(ShortestMove, WithDampingMatchesANumericalIntegration) {
  testing::RandomBlocks draw(4);
  for (int i = 0; i < 20; ++i) {
    const DrivenAxis axis{1.0, draw.log_uniform(0.05, 20.0), draw.log_uniform(0.3, 3.0),
                          draw.log_uniform(0.3, 3.0)};
    const double distance = draw.log_uniform(0.1, 10.0);
    const double time = shortest_move(axis, distance);
    // Drives as long as a brake from the present velocity still stops before the target.
    constexpr int steps = 20000;
    const double dt = time / steps;
    double x = 0.0;
    double v = 0.0;
    double t = 0.0;
    const auto braking_travel = [&](double velocity) {
      const double c = axis.damping;
      return velocity / c - axis.braking / (c * c) * std::log1p(velocity * c / axis.braking);
    };
    while (x + braking_travel(v) < distance) {
      v += dt * (axis.driving - axis.damping * v);
      x += dt * v;
      t += dt;
    }
    t += std::log1p(v * axis.damping / axis.braking) / axis.damping;
    EXPECT_NEAR(t / time, 1.0, 2e-3) << axis.damping << " " << distance;
  }
}

TEST(ShortestMove, IsInfiniteWithoutTorque) {
  EXPECT_TRUE(std::isinf(shortest_move({1.0, 0.1, 0.0, 1.0}, 1.0)));
  EXPECT_TRUE(std::isinf(shortest_move({1.0, 0.1, 1.0, -1.0}, 1.0)));
}

}  // namespace
}  // namespace zerocount::theory
