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
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/theory/frozen_loops.hpp"

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
      const std::vector<LimitCycle> cycles = stick_slip_cycle(p.friction.model, p.friction.uniform, p.plant,
                                                              p.encoder, p.controller, {}, 20000.0);
      ASSERT_EQ(cycles.size(), 1U);
      const LimitCycle* const cycle = cycles.data();
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
  const auto cycles = [&] {
    return stick_slip_cycle(p.friction.model, p.friction.uniform, p.plant, p.encoder, p.controller, {},
                            20000.0)
        .size();
  };
  EXPECT_EQ(cycles(), 1U);
  p.friction.uniform.coulomb_ratio = 1.0;
  EXPECT_EQ(cycles(), 0U);
  p.friction.uniform.coulomb_ratio = 0.8;
  p.controller.ki = 0.0;
  EXPECT_EQ(cycles(), 0U);
}

/// A random stable PID loop that sticks and slides, with few or many samples a period, delay, amplifier and
/// filters.
trial::TrialParameters random_sliding_loop(testing::RandomBlocks& draw, FrictionModel model) {
  trial::TrialParameters p;
  p.friction.model = model;
  p.plant.inertia = draw.log_uniform(1e-4, 1e-2);
  p.plant.sliding_damping = draw.log_uniform(1e-4, 1e-2);
  p.friction.uniform.breakaway = draw.log_uniform(0.05, 0.5);
  p.friction.uniform.coulomb_ratio = draw.chance(0.2) ? 1.0 : draw.uniform(0.5, 0.95);
  p.friction.uniform.stribeck_velocity = draw.log_uniform(1e-4, 1e-2);
  const double crossover = 2.0 * std::numbers::pi * draw.log_uniform(0.5, 5.0);  // rad/s
  const double kp = p.plant.inertia * crossover * crossover;
  p.friction.uniform.sigma0 = draw.log_uniform(2e3, 1e5) * kp;
  p.friction.uniform.sigma1 = 2.0 * std::sqrt(p.friction.uniform.sigma0 * p.plant.inertia);
  p.dac = {.bits = 30, .resolution = 1e-8};
  p.controller.sample_rate = draw.log_uniform(20.0, 400.0) * crossover / std::numbers::pi;
  p.controller.delay = draw.some(draw.uniform(0.0, 1.5));
  p.amplifier.bandwidth = draw.chance(0.3) ? 20.0 * crossover : 0.0;
  const AnalogueGains gains{kp, kp * crossover * draw.uniform(0.05, 0.4),
                            2.0 * p.plant.inertia * crossover * draw.uniform(0.4, 1.0)};
  p.controller = with_analogue_gains(p.controller, gains, p.encoder);
  p.command.targets = {200'000};
  return p;
}

/// Compares the prediction with a trial; returns whether they hunt.
bool hunts_as_predicted(trial::TrialParameters p, double tolerance, int number) {
  const std::vector<LimitCycle> cycles =
      stick_slip_cycle(p.friction.model, p.friction.uniform, p.plant, p.encoder, p.controller,
                       {1.0, p.amplifier.bandwidth}, static_cast<double>(p.command.targets[0]));
  p.command.hold = cycles.empty() ? 60.0 : 20.0 * cycles[0].period;
  const trial::MoveOutcome move = trial::run_trial(p).moves.front();
  const bool hunts = move.outcome == trial::Outcome::oscillating && !std::isnan(move.oscillation_period);
  EXPECT_EQ(hunts, !cycles.empty()) << number;
  if (!hunts || cycles.empty()) return false;
  const double amplitude = move.oscillation_amplitude * loop::fine_resolution(p.encoder);
  EXPECT_NEAR(amplitude, cycles[0].amplitude, tolerance * cycles[0].amplitude) << number;
  EXPECT_NEAR(move.oscillation_period, cycles[0].period, tolerance * cycles[0].period) << number;
  return true;
}

TEST(StickSlipCycle, IsThatOfTrialsOfRandomLoops) {
  testing::RandomBlocks draw(77);
  int hunting = 0;
  for (int i = 0; i < 18; ++i) {
    const bool is_relay = i % 2 == 0;
    const trial::TrialParameters p =
        random_sliding_loop(draw, is_relay ? FrictionModel::coulomb : FrictionModel::lugre);
    hunting += hunts_as_predicted(p, is_relay ? 0.02 : 1.0 / 3.0, i) ? 1 : 0;
  }
  EXPECT_GT(hunting, 9);
}

// The delay of sampling and hold is a large part of such a period.
TEST(StickSlipCycle, IsThatOfTrialsWithFewSamplesAPeriod) {
  testing::RandomBlocks draw(78);
  int hunting = 0;
  for (int i = 0; i < 40; ++i) {
    trial::TrialParameters p = random_sliding_loop(draw, FrictionModel::coulomb);
    const AnalogueGains gains = analogue_gains(p.controller, p.encoder);
    const double crossover = std::sqrt(gains.kp / p.plant.inertia);
    p.controller.sample_rate = crossover * draw.uniform(3.0, 8.0);
    p.controller.delay = 0.0;
    p.controller = with_analogue_gains(p.controller, {gains.kp, 2.0 * gains.ki, gains.kd}, p.encoder);
    p.friction.uniform.coulomb_ratio = draw.uniform(0.4, 0.6);
    if (!stable_while_sliding(p.plant, p.encoder, p.controller, {1.0, p.amplifier.bandwidth})) continue;
    hunting += hunts_as_predicted(p, 0.05, i) ? 1 : 0;
  }
  EXPECT_GT(hunting, 5);
}

// The encoder does not see a cycle of less than a count.
TEST(StickSlipCycle, IsNoneBelowACount) {
  trial::TrialParameters p = loop_with(FrictionModel::coulomb, {2.0, 20.0, 0.05});
  p.friction.uniform.coulomb_ratio = 0.6;
  p.friction.uniform.breakaway = 1e-5;
  EXPECT_TRUE(
      stick_slip_cycle(p.friction.model, p.friction.uniform, p.plant, p.encoder, p.controller, {}, 50.0)
          .empty());
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
