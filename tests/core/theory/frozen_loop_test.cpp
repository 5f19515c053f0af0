// Poles of the closed loop, and what becomes of their motions within a move.
#include "core/theory/frozen_loop.hpp"

#include <Eigen/Dense>

#include "core/loop/controller/control_chain.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/linear_loop.hpp"
#include "core/theory/margins.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/loop/test_blocks.hpp"
#include "tests/core/theory/analogue_controller.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/support/test.hpp"

namespace zerocount::theory {
namespace {

// About a stiff contact an integral takes the time constant (k + kP)/kI, far beyond any hold. That is slow,
// and not marginal, as long as the motion changes by a thousandth within the hold.
TEST(LoopStability, ASlowPoleIsStable) {
  testing::RandomBlocks draw(31);
  for (int i = 0; i < 50; ++i) {
    const motion::PlantParameters plant{.inertia = draw.log_uniform(1e-4, 1.0)};
    const double stiffness = plant.inertia * draw.log_uniform(1e5, 1e7);
    const double damping = 2.0 * draw.log_uniform(0.3, 2.0) * std::sqrt(stiffness * plant.inertia);
    const double hold = draw.log_uniform(1.0, 100.0);
    const AnalogueGains gains{1e-3 * stiffness, stiffness / hold * draw.log_uniform(3e-3, 1.0), 0.0};
    loop::ControllerParameters controller;
    controller.sample_rate = 4000.0;
    controller = with_analogue_gains(controller, gains, {});
    const FrozenLoop loop = frozen_loop(stiffness, damping, plant, {}, controller);
    EXPECT_EQ(stability_of(loop, hold), LoopStability::stable) << i;
    const double tau = (stiffness + gains.kp) / gains.ki;
    EXPECT_NEAR(slowest_time_constant(poles_of(loop), loop.sample_time), tau, 0.01 * tau) << i;
  }
}

TEST(LoopStability, IsJudgedByTheGrowthWithinTheHold) {
  Eigen::VectorXcd poles(2);
  const double T = 1e-3;
  const auto stability = [&](double rate, double hold) {  // rate of growth, 1/s
    poles << 0.5, std::polar(std::exp(rate * T), 0.3);
    return stability_of(poles, T, hold);
  };
  for (const double hold : {0.5, 30.0}) {
    EXPECT_EQ(stability(2e-3 / hold, hold), LoopStability::unstable);
    EXPECT_EQ(stability(5e-4 / hold, hold), LoopStability::marginal);
    EXPECT_EQ(stability(0.0, hold), LoopStability::marginal);
    EXPECT_EQ(stability(-5e-4 / hold, hold), LoopStability::marginal);
    EXPECT_EQ(stability(-2e-3 / hold, hold), LoopStability::stable);
  }
}

// A free mass without control: a double eigenvalue of 1, which rounds.
TEST(LoopStability, AFreeMassIsMarginal) {
  testing::RandomBlocks draw(32);
  for (int i = 0; i < 50; ++i) {
    const motion::PlantParameters plant{.inertia = draw.log_uniform(1e-5, 10.0)};
    loop::ControllerParameters controller;
    controller.sample_rate = draw.log_uniform(500.0, 20000.0);
    controller.ki = 0.0;
    controller.delay = i % 5 / 2.0;
    const FrozenLoop loop = frozen_loop(0.0, 0.0, plant, {}, controller);
    EXPECT_EQ(stability_of(loop, draw.log_uniform(0.1, 100.0)), LoopStability::marginal) << i;
  }
}

// The loop while the rotor slides: its frequency response in closed form, and what it does in time.

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
TEST(SlidingCrossover, MatchesTheClosedFormOfAnUndampedMassUnderProportionalControl) {
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

/// The open-loop response L at a frequency of the whole loop in closed form; its plant by the textbook's
/// table of z-transforms.
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

TEST(SlidingCrossover, IsWhereTheClosedFormHasUnityGain) {
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
TEST(SlidingCrossover, ApproachesTheContinuousLoopForFastSampling) {
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

TEST(SlidingCrossover, IsAbsentWithoutGain) {
  loop::ControllerParameters controller;
  controller.ki = 0.0;
  EXPECT_TRUE(std::isnan(sliding_crossover({}, {}, controller).frequency));
  controller.kp = 1e3;
  EXPECT_TRUE(std::isnan(sliding_crossover({}, {}, controller).frequency));
}

// The paper's machine has a pure integral in its fine phase: two integrators in a row, which nothing can hold
// while it slides; the coarse phase is there for that.
TEST(SlidingLoop, MachineOfThePaperIsStableOnlyInTheCoarsePhase) {
  loop::ControllerParameters controller;
  controller.coarse.coarse_beyond = 300.0;
  const loop::ControllerParameters fine = loop::controller_in_phase(controller, loop::ControlPhase::fine);
  const loop::ControllerParameters coarse = loop::controller_in_phase(controller, loop::ControlPhase::coarse);
  EXPECT_FALSE(stable_while_sliding({}, {}, fine));
  EXPECT_LT(sliding_crossover({}, {}, fine).phase_margin, 0.0);
  EXPECT_TRUE(stable_while_sliding({}, {}, coarse));
  EXPECT_GT(sliding_crossover({}, {}, coarse).phase_margin, 0.0);
}

TEST(SlidingLoop, HasNoDerivativeInTheFinePhase) {
  loop::ControllerParameters controller;
  controller.kd = 1e-3;
  EXPECT_EQ(loop::controller_in_phase(controller, loop::ControlPhase::fine).kd, 1e-3);
  controller.coarse.coarse_beyond = 300.0;
  EXPECT_EQ(loop::controller_in_phase(controller, loop::ControlPhase::fine).kd, 0.0);
  EXPECT_EQ(loop::controller_in_phase(controller, loop::ControlPhase::coarse).kd, controller.coarse.kd);
  controller.velocity_by_other = true;
  EXPECT_FALSE(loop::controller_in_phase(controller, loop::ControlPhase::coarse).velocity_by_other);
}

// The linear loop assembled from the blocks of a controller, with blocks that only the tests know.

constexpr double count_of_paper = 2.0 * std::numbers::pi / 1'620'000;
constexpr loop::ControlStart wide{
    .integral_range = {-1e300, 1e300}, .resolution = count_of_paper, .velocity_resolution = count_of_paper};

HeldPlant paper_machine(double delay) {
  return hold_plant({300.0, 0.2}, {}, 2.0 * std::numbers::pi / 1'620'000, 5e-4, {1.1, 400.0}, delay);
}

/// Growth factor per sample of the loop, simulated with the `step` functions of its blocks.
template <class Chain>
double growth_in_time(Chain chain, const HeldPlant& plant) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(plant.A.rows());
  x(0) = 10.0;
  std::deque<double> pending(static_cast<std::size_t>(plant.delay + 1), 0.0);
  double in_force = 0.0;
  const auto largest_of_next = [&](int samples) {
    double largest = 0.0;
    for (int k = 0; k < samples; ++k) {
      in_force =
          chain.step({.error = -x(0), .count = x(0), .torque_in_force = in_force, .velocity_count = x(0)});
      pending.push_back(in_force);
      x = plant.A * x + plant.b_before * pending[0] + plant.b * pending[1];
      pending.pop_front();
      largest = std::max(largest, std::abs(x(0)) + std::abs(x(1)));
    }
    return largest;
  };
  constexpr int window = 2000;
  largest_of_next(window);  // the transient of the other eigenvalues
  const double early = largest_of_next(window);
  largest_of_next(4 * window);
  return std::pow(largest_of_next(window) / early, 1.0 / (5 * window));
}

template <class Chain>
void expect_growth(const loop::ControllerParameters& parameters) {
  const Chain chain(parameters, wide);
  for (const double delay : {0.0, 0.4, 1.0, 2.7, 3.0}) {
    const HeldPlant plant = paper_machine(delay);
    // The phase of the oscillation at the ends of the windows is worth some 1e-5.
    EXPECT_NEAR(spectral_radius(plant, chain.linear()), growth_in_time(Chain(parameters, wide), plant), 5e-5);
    // Every mode of the loop is a root of 1 + L(z).
    for (const std::complex<double> z : loop_map(plant, chain.linear()).eigenvalues()) {
      if (std::abs(z) < 0.1) continue;
      EXPECT_LT(std::abs(1.0 + OpenLoop(plant, chain.linear()).at(z)), 1e-7) << z;
    }
  }
}

TEST(LinearLoop, GrowthMatchesTheSimulatedLoop) {
  const loop::ControllerParameters parameters{.kp = 1e-4, .ki = 1.4e-4, .kd = 1e-4};
  expect_growth<loop::BlockChain<loop::Pid>>(parameters);
  expect_growth<loop::BlockChain<loop::Pid, LowPass>>(parameters);
  expect_growth<loop::BlockChain<loop::Pid, TorqueFeedback>>(parameters);
  expect_growth<loop::BlockChain<loop::Pid, LowPass, TorqueFeedback>>(parameters);
}

TEST(LinearLoop, GrowthMatchesTheSimulatedLoopWithEveryBlock) {
  loop::ControllerParameters parameters{.kp = 1e-4, .ki = 1.4e-4, .kd = 2e-4};
  parameters.blocks.integrator_leak = 0.05;
  parameters.blocks.derivative_cutoff = 200.0;
  parameters.blocks.observer.bandwidth = 30.0;
  parameters.blocks.filters = {{.kind = loop::FilterKind::lead, .frequency = 300.0},
                               {.kind = loop::FilterKind::notch, .frequency = 250.0}};
  expect_growth<loop::ControlChain>(parameters);
  parameters.blocks.structure = loop::ControlStructure::cascade;
  parameters.blocks.cascade = {5.0, 0.1, 10.0};
  expect_growth<loop::ControlChain>(parameters);
}

}  // namespace
}  // namespace zerocount::theory
