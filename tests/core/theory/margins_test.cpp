// Gain and phase margins: what they say of the closed loop, and closed forms.
#include "core/theory/margins.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "core/loop/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/linear_loop.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/theory/frozen_loops.hpp"

namespace zerocount::theory {
namespace {

// Times the gain margin the loop has an eigenvalue on the unit circle, at the frequency of the crossover.
TEST(Margins, GainMarginIsTheFactorToTheEdgeOfStability) {
  testing::RandomBlocks draw(12);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    loop::ControllerParameters controller;
    controller.kp = draw.some(draw.log_uniform(1e-5, 1e-3));
    controller.kd = draw.some(draw.log_uniform(1e-4, 5e-3));
    controller.delay = i % 6 / 2.0;
    controller.blocks = draw.blocks(testing::BlockKind::all, controller.sample_rate);
    controller.blocks.observer.bandwidth = 0.0;  // it knows the gain of the controller, but not of the drive
    const double stiffness = draw.log_uniform(50.0, 1000.0);
    LinearDrive drive{draw.log_uniform(0.5, 2.0), draw.some(500.0)};
    const StabilityMargins margins = margins_about(stiffness, 0.2, {}, {}, controller, drive);
    if (std::isnan(margins.gain.value)) continue;
    ++found;
    drive.gain *= margins.gain.value;
    const double T = 1.0 / controller.sample_rate;
    const double resolution = loop::fine_resolution({});
    const HeldPlant plant = hold_plant(stiffness, 0.2, {}, resolution, T, drive, controller.delay);
    const Eigen::MatrixXd map = loop_map(plant, loop::linear_chain(controller, resolution));
    const std::complex<double> expected =
        std::polar(1.0, 2.0 * std::numbers::pi * margins.gain.frequency * T);
    double nearest = 1.0;
    for (const std::complex<double> z : map.eigenvalues())
      nearest = std::min(nearest, std::abs(z - expected));
    EXPECT_LT(nearest, 1e-6) << i;
  }
  EXPECT_GT(found, 80);
}

// An undamped mass under kp alone, its crossover by the closed form of SlidingCrossover's test.
TEST(Margins, PhaseMarginOfAMassUnderProportionalControlIsAClosedForm) {
  for (const double g : {1e-4, 1e-2, 0.5}) {
    const motion::PlantParameters plant;
    loop::ControllerParameters controller;
    controller.ki = 0.0;
    const double T = 1.0 / controller.sample_rate;
    controller.kp = g * 2.0 * plant.inertia * loop::fine_resolution({}) / (T * T);
    const double phi = std::acos(-g / 4.0 + std::sqrt(g * g / 16.0 + 1.0));
    const StabilityMargins margins = margins_about(0.0, 0.0, plant, {}, controller);
    EXPECT_NEAR(margins.phase.value, -phi * 180.0 / std::numbers::pi, 1e-4);
    EXPECT_NEAR(margins.phase.frequency, phi / (std::numbers::pi * T), 1e-6 * phi / (std::numbers::pi * T));
  }
}

TEST(Margins, AreNotThereWithoutGain) {
  loop::ControllerParameters controller;
  controller.ki = 0.0;
  const StabilityMargins margins = margins_about(110.0, 0.2, {}, {}, controller);
  EXPECT_TRUE(std::isnan(margins.gain.value));
  EXPECT_TRUE(std::isnan(margins.phase.value));
}

// A peak so narrow that no grid of frequencies meets it by chance, in a loop whose gain is below 1 elsewhere.
TEST(Margins, SeeANarrowResonance) {
  loop::ControllerParameters controller;
  controller.ki = 0.0;
  controller.kp = 1e-5;
  EXPECT_TRUE(std::isnan(margins_about(110.0, 0.2, {}, {}, controller).phase.value));
  controller.blocks.filters = {
      {.kind = loop::FilterKind::notch, .frequency = 321.0, .damping = 1e-5, .depth = 1e5}};
  EXPECT_NEAR(margins_about(110.0, 0.2, {}, {}, controller).phase.frequency, 321.0, 1.0);
}

}  // namespace
}  // namespace zerocount::theory
