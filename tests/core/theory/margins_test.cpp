// Gain and phase margins: what they say of the closed loop, and closed forms.
#include "core/theory/margins.hpp"

#include <Eigen/Dense>

#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/linear_loop.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/support/test.hpp"

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
    const HeldPlant plant = hold_plant({stiffness, 0.2}, {}, resolution, T, drive, controller.delay);
    const Eigen::MatrixXd map = loop_map(plant, loop::linear_chain(controller, {}));
    const std::complex<double> expected =
        std::polar(1.0, 2.0 * std::numbers::pi * margins.gain.frequency * T);
    double nearest = 1.0;
    for (const std::complex<double> z : map.eigenvalues())
      nearest = std::min(nearest, std::abs(z - expected));
    EXPECT_LT(nearest, 1e-6) << i;
  }
  EXPECT_GT(found, 80);
}

/// A random loop, in every second case about a spring without damping, with up to 12 samples of delay.
FrozenLoop random_loop(testing::RandomBlocks& draw, int i) {
  const motion::PlantParameters plant{.inertia = draw.log_uniform(1e-4, 1e-2)};
  const double stiffness = draw.log_uniform(50.0, 1000.0);
  const double damping = i % 2 == 0 ? 0.0 : draw.log_uniform(1e-4, 1.0);
  loop::ControllerParameters controller;
  controller.sample_rate = draw.log_uniform(1e3, 2e4);
  const double resolution = loop::fine_resolution({});
  controller.kp = stiffness * resolution * draw.log_uniform(0.1, 20.0);
  controller.ki = draw.some(stiffness * resolution * draw.log_uniform(1e-4, 0.1));
  controller.kd = draw.some(draw.log_uniform(1e-4, 5e-3));
  controller.delay = i % 25 / 2.0;
  return frozen_loop(stiffness, damping, plant, {}, controller, {1.0, draw.some(2000.0)});
}

/// The smallest stability margins found by a fine scan of the frequency response, independent of the search
/// under test: from successive frequencies whose responses lie on both sides of the unit circle or of the
/// negative real axis.
StabilityMargins scanned_margins(const FrozenLoop& loop) {
  constexpr int points = 20'000;
  constexpr double lowest = 1e-4;
  StabilityMargins margins{{1e9, 0.0}, {1e9, 0.0}, {}};
  std::complex<double> last;
  for (int i = 0; i <= points; ++i) {
    const double angle = lowest + (std::numbers::pi - lowest) * i / points;
    const std::complex<double> now = open_loop(loop).at_angle(angle);
    const bool jumps = i == 0 || std::abs(now / last - 1.0) > 0.5;  // across a resonance without damping
    if (!jumps && (std::abs(now) > 1.0) != (std::abs(last) > 1.0))
      margins.phase.value =
          std::min(margins.phase.value, std::abs(std::arg(-now)) * 180.0 / std::numbers::pi);
    if (!jumps && (now.imag() > 0.0) != (last.imag() > 0.0)) {
      const double at = last.real() + (now.real() - last.real()) * last.imag() / (last.imag() - now.imag());
      if (at < 0.0) margins.gain.value = std::min(margins.gain.value, std::abs(std::log(-at)));
    }
    last = now;
  }
  return margins;
}

TEST(Margins, MatchAFineScanWithAndWithoutDamping) {
  testing::RandomBlocks draw(13);
  int with_phase = 0;
  for (int i = 0; i < 40; ++i) {
    const FrozenLoop loop = random_loop(draw, i);
    const StabilityMargins margins = stability_margins(loop);
    const StabilityMargins scanned = scanned_margins(loop);
    if (scanned.phase.value < 1e9) {
      ++with_phase;
      EXPECT_LT(std::abs(margins.phase.value), scanned.phase.value + 0.3) << i;
      EXPECT_GT(std::abs(margins.phase.value), scanned.phase.value - 0.3) << i;
    }
    // A scan does not resolve the summit of a resonance, and does not know which gains are stable.
    if (scanned.gain.value > 3.0 || stability_of(loop, 1e3) == LoopStability::unstable) continue;
    EXPECT_NEAR(std::abs(std::log(margins.gain.value)), scanned.gain.value, 0.02) << i;
  }
  EXPECT_GT(with_phase, 25);
}

/// Growth rate of the loop per sample (logarithm of the spectral radius) if the gain of its plant is
/// multiplied by `factor`; below 0 the loop is stable.
double growth_with(FrozenLoop loop, double factor) {
  loop.plant.b *= factor;
  loop.plant.b_before *= factor;
  return std::log(spectral_radius(loop.plant, loop.controller));
}

// The gain margin of an unstable loop is the smallest change of the gain that makes it stable, by a scan of
// the gain over six decades. If the scan finds no stable gain, there is no margin, and the reason is told.
TEST(Margins, GainMarginOfAnUnstableLoopMakesItStable) {
  constexpr double visible = 1e-6;  // growth per sample
  constexpr double step = 1.15;
  testing::RandomBlocks draw(31);
  int helped = 0;
  int lost = 0;
  for (int i = 0; i < 70; ++i) {
    const FrozenLoop loop = random_loop(draw, i);
    if (growth_with(loop, 1.0) < visible) continue;
    const StabilityMargins margins = stability_margins(loop);
    double nearest = std::numeric_limits<double>::infinity();  // |ln| of a stable factor
    for (double factor = 1e-3; factor < 1e3; factor *= step)
      if (growth_with(loop, factor) < -visible) nearest = std::min(nearest, std::abs(std::log(factor)));
    if (std::isnan(margins.gain.value)) {
      ++lost;
      EXPECT_TRUE(margins.no_gain_stabilises) << i;
      EXPECT_TRUE(std::isinf(nearest)) << i << " " << nearest;
      continue;
    }
    EXPECT_FALSE(margins.no_gain_stabilises) << i;
    constexpr double beside = 1e-3;
    EXPECT_LT(std::min(growth_with(loop, margins.gain.value * (1.0 - beside)),
                       growth_with(loop, margins.gain.value * (1.0 + beside))),
              1e-9)
        << i;
    if (std::isinf(nearest)) continue;
    ++helped;
    EXPECT_LE(std::abs(std::log(margins.gain.value)), nearest + 1e-9) << i;
  }
  EXPECT_GT(helped, 5);
  EXPECT_GT(lost, 5);
}

// With the delay that the phase margin allows, the loop has a pole on the unit circle at the crossover.
TEST(Margins, PhaseMarginIsADelayToTheEdgeOfStability) {
  testing::RandomBlocks draw(14);
  int found = 0;
  for (int i = 0; i < 60; ++i) {
    const FrozenLoop loop = random_loop(draw, i);
    const Margin phase = stability_margins(loop).phase;
    if (std::isnan(phase.value)) continue;
    ++found;
    const double angle = 2.0 * std::numbers::pi * phase.frequency * loop.sample_time;
    const double delay = phase.value / 180.0 * std::numbers::pi / angle;  // samples
    const std::complex<double> value = open_loop(loop).at_angle(angle) * std::polar(1.0, -angle * delay);
    EXPECT_LT(std::abs(value + 1.0), 1e-6) << i;
  }
  EXPECT_GT(found, 40);
}

// L is at least 1/Mₛ away from −1, so both margins of a stable loop have a lower bound; and the peak is that
// of a fine scan, which it may exceed.
TEST(Margins, PeakOfTheSensitivityBoundsTheOtherMargins) {
  testing::RandomBlocks draw(15);
  int stable = 0;
  for (int i = 0; i < 300; ++i) {
    const FrozenLoop loop = random_loop(draw, i);
    const Margin peak = peak_sensitivity(loop);
    double scanned = 0.0;
    for (int k = 1; k <= 2000; ++k)
      scanned =
          std::max(scanned, 1.0 / std::abs(1.0 + open_loop(loop).at_angle(std::numbers::pi * k / 2000.5)));
    EXPECT_GE(peak.value, scanned * (1.0 - 1e-9)) << i;
    const double angle = 2.0 * std::numbers::pi * peak.frequency * loop.sample_time;
    EXPECT_NEAR(1.0 / std::abs(1.0 + open_loop(loop).at_angle(angle)), peak.value, 1e-9 * peak.value) << i;
    if (stability_of(loop, 1e3) != LoopStability::stable) continue;
    ++stable;
    const StabilityMargins margins = stability_margins(loop);
    // Without a crossover a margin is NaN, and there is nothing to bound.
    EXPECT_FALSE(margins.gain.value > 1.0 &&
                 margins.gain.value < peak.value / (peak.value - 1.0) * (1.0 - 1e-9))
        << i;
    EXPECT_FALSE(std::abs(margins.phase.value) <
                 std::asin(0.5 / peak.value) * 360.0 / std::numbers::pi - 1e-6)
        << i;
  }
  EXPECT_GT(stable, 30);
}

// An undamped mass under kp alone, its crossover by the closed form of SlidingCrossover's test.
TEST(Margins, PhaseMarginMatchesTheClosedFormOfAMassUnderProportionalControl) {
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

TEST(Margins, AreAbsentWithoutGain) {
  loop::ControllerParameters controller;
  controller.ki = 0.0;
  const StabilityMargins margins = margins_about(110.0, 0.2, {}, {}, controller);
  EXPECT_TRUE(std::isnan(margins.gain.value));
  EXPECT_TRUE(std::isnan(margins.phase.value));
}

// A peak so narrow that no grid of frequencies meets it by chance, in a loop whose gain is below 1 elsewhere.
TEST(Margins, FindANarrowResonance) {
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
