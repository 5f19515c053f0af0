// The loop while the rotor slides: its frequency response in closed form, and what it does in time.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/loop/controller/controller.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/margins.hpp"
#include "tests/core/theory/frozen_loops.hpp"

namespace zerocount::theory {
namespace {

constexpr double pi = std::numbers::pi;

class RandomLoops {
 public:
  double log_uniform(double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<double>(0.0, 1.0)(random_));
  }
  motion::PlantParameters plant() {
    return {.inertia = log_uniform(1e-5, 1e-1),
            .presliding_damping = 0.2,
            .sliding_damping = log_uniform(1e-4, 1e-1)};
  }
  std::mt19937_64 random_{1234};
};

// With kp alone and no damping, |L| = kp·T²/(2·J·Δx)·cos φ/(2·sin² φ) with φ = ωT/2, which is 1 where
// 2·sin² φ = g·cos φ with g = kp·T²/(2·J·Δx), a quadratic equation in cos φ; the phase is −180° − φ.
TEST(SlidingCrossover, OfAnUndampedMassUnderProportionalControlIsAClosedForm) {
  RandomLoops random;
  for (int i = 0; i < 50; ++i) {
    motion::PlantParameters plant = random.plant();
    plant.sliding_damping = 0.0;
    loop::ControllerParameters controller;
    controller.ki = 0.0;
    controller.sample_rate = random.log_uniform(500.0, 50'000.0);
    const double T = 1.0 / controller.sample_rate;
    const loop::EncoderParameters encoder;
    const double g = random.log_uniform(1e-4, 1.0);
    controller.kp = g * 2.0 * plant.inertia * loop::fine_resolution(encoder) / (T * T);
    const double cosine = -g / 4.0 + std::sqrt(g * g / 16.0 + 1.0);
    const double phi = std::acos(cosine);
    const GainCrossover crossover = sliding_crossover(plant, encoder, controller);
    EXPECT_NEAR(crossover.frequency, 2.0 * phi / T / (2.0 * pi), 1e-6 * crossover.frequency);
    EXPECT_NEAR(crossover.phase_margin, -phi * 180.0 / pi, 1e-4);
    EXPECT_FALSE(stable_while_sliding(plant, encoder, controller));
  }
}

/// L of the whole loop in closed form, its plant by the textbook's table of z-transforms.
std::complex<double> open_loop(double frequency, const motion::PlantParameters& plant,
                               const loop::EncoderParameters& encoder, const loop::ControllerParameters& c,
                               double gain) {
  const double T = 1.0 / c.sample_rate;
  const std::complex<double> z = std::polar(1.0, 2.0 * pi * frequency * T);
  const double a = plant.sliding_damping / plant.inertia;
  const double E = std::exp(-a * T);
  const std::complex<double> G =
      ((a * T - 1.0 + E) * z + (1.0 - E - a * T * E)) /
      (a * plant.sliding_damping * loop::fine_resolution(encoder) * (z - 1.0) * (z - E));
  return (c.kp + c.ki * (z + 1.0) / (z - 1.0) + c.kd * (1.0 - 1.0 / z)) * std::pow(z, -c.delay) * G * gain;
}

TEST(SlidingCrossover, IsWhereTheClosedFormHasTheGain1) {
  RandomLoops random;
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    motion::PlantParameters plant = random.plant();
    plant.sliding_damping = plant.inertia * random.log_uniform(10.0, 1000.0);  // so that E is not close to 1
    loop::EncoderParameters encoder;
    encoder.fine = std::floor(random.log_uniform(1e4, 1e8));
    loop::ControllerParameters controller;
    controller.sample_rate = random.log_uniform(500.0, 50'000.0);
    const double T = 1.0 / controller.sample_rate;
    const double scale = 2.0 * plant.inertia * loop::fine_resolution(encoder) / (T * T);
    controller.kp = scale * random.log_uniform(1e-5, 1e-1);
    controller.ki = controller.kp * random.log_uniform(1e-4, 1e-1);
    controller.kd = controller.kp * random.log_uniform(1e-1, 1e2);
    controller.delay = static_cast<int>(random.random_() % 4);
    const LinearDrive drive{.gain = random.log_uniform(0.8, 1.25)};
    const GainCrossover crossover = sliding_crossover(plant, encoder, controller, drive);
    if (std::isnan(crossover.frequency)) continue;
    ++found;
    const std::complex<double> L = open_loop(crossover.frequency, plant, encoder, controller, drive.gain);
    EXPECT_NEAR(std::abs(L), 1.0, 1e-5);
    EXPECT_NEAR(std::abs(std::remainder(std::arg(L) * 180.0 / pi - crossover.phase_margin, 360.0)), 180.0,
                1e-3);
    for (double f = 1.02 * crossover.frequency; f < 0.5 / T; f *= 1.05)
      EXPECT_LT(std::abs(open_loop(f, plant, encoder, controller, drive.gain)), 1.0);
  }
  EXPECT_GT(found, 100);
}

// A PD control that samples fast compared to its bandwidth: the textbook's continuous loop.
TEST(SlidingCrossover, TendsToTheContinuousLoopsWhereSamplingIsFast) {
  const motion::PlantParameters plant{.inertia = 1e-3, .presliding_damping = 0.2, .sliding_damping = 0.02};
  const loop::EncoderParameters encoder;
  loop::ControllerParameters controller;
  controller.sample_rate = 1e6;
  const double w = 2.0 * pi * 40.0;  // the crossover to be found, rad/s
  const double zero = w / 3.0;       // of the control, rad/s
  const double size =
      std::hypot(w * w * plant.inertia, w * plant.sliding_damping) / std::hypot(1.0, w / zero);
  const GainCrossover crossover = sliding_crossover(
      plant, encoder, with_analogue_gains(controller, {.kp = size, .ki = 0.0, .kd = size / zero}, encoder));
  EXPECT_NEAR(crossover.frequency, 40.0, 0.01);
  const double phase = std::atan(3.0) - pi / 2.0 - std::atan(w * plant.inertia / plant.sliding_damping);
  EXPECT_NEAR(crossover.phase_margin, 180.0 + phase * 180.0 / pi, 0.1);
}

TEST(SlidingCrossover, FallsWithADelayAndAnAmplifierThatLags) {
  const motion::PlantParameters plant;
  loop::ControllerParameters controller;
  controller.kp = 5e-4;
  controller.kd = 6e-3;
  const GainCrossover fast = sliding_crossover(plant, {}, controller);
  const GainCrossover lags = sliding_crossover(plant, {}, controller, {.bandwidth = 200.0});
  controller.delay = 3;
  const GainCrossover late = sliding_crossover(plant, {}, controller);
  EXPECT_NEAR(late.frequency, fast.frequency, 1e-9 * fast.frequency);
  EXPECT_NEAR(fast.phase_margin - late.phase_margin, 360.0 * fast.frequency * 3.0 / controller.sample_rate,
              1e-6);
  EXPECT_LT(lags.frequency, fast.frequency);
  EXPECT_LT(lags.phase_margin, fast.phase_margin - 1.0);
}

TEST(SlidingCrossover, IsNotThereWithoutGain) {
  loop::ControllerParameters controller;
  controller.ki = 0.0;
  EXPECT_TRUE(std::isnan(sliding_crossover({}, {}, controller).frequency));
  controller.kp = 1e3;
  EXPECT_TRUE(std::isnan(sliding_crossover({}, {}, controller).frequency));
}

// The paper's rig has a pure integral in its fine phase: two integrators in a row, which nothing can hold
// while it slides; the coarse phase is there for that.
TEST(SlidingLoop, OfThePapersRigIsStableInTheCoarsePhaseAlone) {
  loop::ControllerParameters controller;
  controller.coarse.coarse_beyond = 300.0;
  const loop::ControllerParameters fine = loop::controller_in_phase(controller, loop::ControlPhase::fine);
  const loop::ControllerParameters coarse = loop::controller_in_phase(controller, loop::ControlPhase::coarse);
  EXPECT_FALSE(stable_while_sliding({}, {}, fine));
  EXPECT_LT(sliding_crossover({}, {}, fine).phase_margin, 0.0);
  EXPECT_TRUE(stable_while_sliding({}, {}, coarse));
  EXPECT_GT(sliding_crossover({}, {}, coarse).phase_margin, 0.0);
}

TEST(SlidingLoop, HasNoDerivativeInTheFineOfTwoPhases) {
  loop::ControllerParameters controller;
  controller.kd = 1e-3;
  EXPECT_EQ(loop::controller_in_phase(controller, loop::ControlPhase::fine).kd, 1e-3);
  controller.coarse.coarse_beyond = 300.0;
  EXPECT_EQ(loop::controller_in_phase(controller, loop::ControlPhase::fine).kd, 0.0);
  EXPECT_EQ(loop::controller_in_phase(controller, loop::ControlPhase::coarse).kd, controller.coarse.kd);
}

}  // namespace
}  // namespace zerocount::theory
