// Predictions of hunting: describing functions against their limits, cycles against trials.
#include "core/theory/hunting.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "core/loop/encoder.hpp"
#include "core/theory/describing_function.hpp"
#include "core/theory/gains.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::theory {
namespace {

using friction::FrictionModel;

constexpr double frequency = 200.0;  // rad/s

TEST(DescribingFunction, OfCoulombFrictionIsThatOfARelay) {
  friction::FrictionParameters contact;
  contact.coulomb_ratio = 1.0;
  const motion::PlantParameters plant;
  for (const double amplitude : {1e-6, 1e-3, 0.1}) {
    const std::complex<double> n =
        describing_function(FrictionModel::coulomb, contact, plant, amplitude, frequency);
    EXPECT_EQ(n.real(), 0.0);
    const double relay = 4.0 * contact.breakaway / (std::numbers::pi * amplitude);
    EXPECT_NEAR(n.imag(), relay + plant.sliding_damping * frequency, 2e-5 * relay);
  }
}

// A small amplitude sees the bristle as a spring and a damper, a large one as a relay of the Coulomb level.
TEST(DescribingFunction, OfABristleGoesFromASpringToARelay) {
  const friction::FrictionParameters contact;
  const motion::PlantParameters plant;
  const std::complex<double> small =
      describing_function(FrictionModel::lugre, contact, plant, 1e-9, frequency);
  EXPECT_NEAR(small.real(), contact.sigma0, 1e-4 * contact.sigma0);
  EXPECT_NEAR(small.imag(), frequency * (contact.sigma1 + plant.sliding_damping), 2e-2);
  const double amplitude = 2.0;
  const std::complex<double> large =
      describing_function(FrictionModel::dahl, contact, plant, amplitude, frequency);
  const double relay = 4.0 * contact.coulomb_ratio * contact.breakaway / (std::numbers::pi * amplitude);
  EXPECT_NEAR(large.imag() - plant.presliding_damping * frequency, relay, 1e-3 * relay);
  EXPECT_LT(std::abs(large.real()), 2e-2 * relay);
}

/// A loop of the paper's rotor with these continuous gains.
trial::TrialParameters loop_with(FrictionModel model, const AnalogueGains& gains) {
  trial::TrialParameters p;
  p.friction.model = model;
  p.dac = {.bits = 20, .resolution = 1e-5};
  p.controller = with_analogue_gains(p.controller, gains, p.encoder);
  p.command.targets = {20000};
  p.command.hold = 20.0;
  return p;
}

// A stable PID loop hunts by its static level alone: as far as that exceeds the Coulomb level.
TEST(StickSlipCycle, IsThatOfTrials) {
  for (const double integral : {5.0, 20.0}) {
    for (const double ratio : {0.6, 0.8}) {
      trial::TrialParameters p = loop_with(FrictionModel::coulomb, {2.0, integral, 0.05});
      p.friction.uniform.coulomb_ratio = ratio;
      p.friction.uniform.stribeck_velocity = 1e-3;
      const std::optional<LimitCycle> cycle =
          stick_slip_cycle(p.friction.uniform, p.plant, p.encoder, p.controller);
      ASSERT_TRUE(cycle);
      p.command.hold = 40.0 * cycle->period;
      const trial::MoveOutcome move = trial::run_trial(p).moves.front();
      ASSERT_EQ(move.outcome, trial::Outcome::oscillating);
      EXPECT_NEAR(move.oscillation_amplitude * loop::fine_resolution(p.encoder), cycle->amplitude,
                  0.005 * cycle->amplitude)
          << integral << " " << ratio;
      EXPECT_NEAR(move.oscillation_period, cycle->period, 0.005 * cycle->period) << integral << " " << ratio;
    }
  }
}

TEST(StickSlipCycle, IsNoneWithoutAStaticLevelOrAnIntegral) {
  trial::TrialParameters p = loop_with(FrictionModel::coulomb, {2.0, 5.0, 0.05});
  p.friction.uniform.coulomb_ratio = 1.0;
  EXPECT_FALSE(stick_slip_cycle(p.friction.uniform, p.plant, p.encoder, p.controller));
  p.friction.uniform.coulomb_ratio = 0.8;
  p.controller.ki = 0.0;
  EXPECT_FALSE(stick_slip_cycle(p.friction.uniform, p.plant, p.encoder, p.controller));
}

// Above the gain at which the loop about the bristle's stiffness becomes unstable, hysteresis limits the
// oscillation.
TEST(HarmonicBalance, OfABristleIsThatOfTrials) {
  for (const double gain : {3.4e-4, 3.8e-4}) {
    trial::TrialParameters p;
    p.friction.model = FrictionModel::lugre;
    p.dac = {.bits = 20, .resolution = 1e-5};
    p.controller.ki = gain;
    p.command.targets = {10};
    p.command.hold = 1.0;
    const std::vector<LimitCycle> cycles =
        harmonic_balance(p.friction.model, p.friction.uniform, p.plant, p.encoder, p.controller);
    ASSERT_EQ(cycles.size(), 1U);
    const trial::MoveOutcome move = trial::run_trial(p).moves.front();
    ASSERT_EQ(move.outcome, trial::Outcome::oscillating);
    // A count is measured in whole numbers.
    EXPECT_NEAR(move.oscillation_amplitude, cycles[0].amplitude / loop::fine_resolution(p.encoder), 1.5)
        << gain;
    EXPECT_NEAR(move.oscillation_period, cycles[0].period, 0.01 * cycles[0].period) << gain;
  }
}

// A dead zone of the error lowers the gain at small amplitudes, so that some of these loops rest.
TEST(HarmonicBalance, WithADeadZoneOfTheErrorIsThatOfTrials) {
  for (const loop::DeadbandForm form : {loop::DeadbandForm::zero, loop::DeadbandForm::subtract}) {
    for (const double band : {1.0, 2.0, 4.0, 8.0}) {
      trial::TrialParameters p;
      p.friction.model = FrictionModel::lugre;
      p.dac = {.bits = 20, .resolution = 1e-5};
      p.controller.ki = 3.8e-4;
      p.controller.blocks.error_deadband = {band, form};
      p.command.targets = {20};
      p.command.hold = 3.0;
      const std::vector<LimitCycle> cycles =
          harmonic_balance(p.friction.model, p.friction.uniform, p.plant, p.encoder, p.controller);
      const trial::MoveOutcome move = trial::run_trial(p).moves.front();
      ASSERT_EQ(move.outcome == trial::Outcome::oscillating, !cycles.empty()) << band;
      if (cycles.empty()) continue;
      EXPECT_NEAR(move.oscillation_amplitude, cycles[0].amplitude / loop::fine_resolution(p.encoder), 1.5);
      EXPECT_NEAR(move.oscillation_period, cycles[0].period, 0.01 * cycles[0].period) << band;
    }
  }
}

// At a stable gain, and far above the bound, where no amplitude has damping enough.
TEST(HarmonicBalance, IsNoneWhereNothingBalances) {
  loop::ControllerParameters controller;
  for (const double gain : {2e-4, 8e-4}) {
    controller.ki = gain;
    EXPECT_TRUE(harmonic_balance(FrictionModel::lugre, {}, {}, {}, controller).empty()) << gain;
  }
  EXPECT_TRUE(harmonic_balance(FrictionModel::presliding, {}, {}, {}, controller).empty());
}

}  // namespace
}  // namespace zerocount::theory
