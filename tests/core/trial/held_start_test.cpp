// An axis that holds what acts on it and on its second mass stands still, with the contact or the integral
// carrying it, whatever lies between the integral and the motor.
#include <algorithm>
#include <cmath>

#include "core/trial/machine.hpp"
#include "core/trial/trial.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr double encoder_phase = 0.5;

/// A joint whose load is pushed by a constant torque and by ripples, behind a gear with a gap and an error.
struct HeldAxis {
  static constexpr unsigned seeds = 60;

  explicit HeldAxis(unsigned seed) : draws(seed) {
    using Model = friction::FrictionModel;
    constexpr Model models[]{Model::spring, Model::coulomb, Model::dahl,
                             Model::lugre,  Model::gms,     Model::none};
    p.friction.model = models[seed % std::size(models)];
    p.friction.uniform.alpha = 0.0;  // creep moves what is held
    p.initial.holding = true;
    p.initial.encoder_phase = encoder_phase;
    p.initial.position = draws.uniform(0.0, 6.0);
    p.plant.load = {.inertia = draws.log_uniform(1e-4, 1e-2),
                    .stiffness = draws.log_uniform(100.0, 1e4),
                    .damping = 0.01,
                    .gap = draws.chance(0.5) ? draws.log_uniform(1e-5, 1e-2) : 0.0};
    const double size = draws.log_uniform(0.01, 10.0) * p.friction.uniform.breakaway;
    p.disturbance.torque = draws.uniform(-size, size);
    p.load_side.disturbance = {.torque = draws.uniform(-size, size),
                               .ripple = {{draws.uniform(-size, size), 1.0, 0.0, draws.uniform(0.0, 6.0)}}};
    if (draws.chance(0.5)) p.load_side.error = {{draws.log_uniform(1e-5, 1e-3), 50.0, 0.0, 1.0}};
    // A converter so fine that its rounding moves nothing, and a controller that keeps its integral.
    p.dac = {.bits = 52, .resolution = 1e-13};
    p.controller.kp = p.controller.ki = p.controller.kd = 0.0;
    p.command = {.targets = {0}, .hold = 0.05};
    put_a_drive_between();
  }

  /// Adds random effects between the integral and the motor, such as a delay.
  void put_a_drive_between() {
    if (draws.chance(0.7)) p.controller.delay = draws.uniform(0.0, 3.5);
    if (draws.chance(0.5)) p.amplifier.bandwidth = draws.log_uniform(20.0, 5000.0);
    if (draws.chance(0.4)) p.controller.jitter = draws.uniform(0.0, 0.9) / p.controller.sample_rate;
    if (draws.chance(0.4)) p.controller.missed = 0.4;
    loop::ControlBlocks& blocks = p.controller.blocks;
    if (draws.chance(0.4))
      blocks.filters = {{.kind = loop::FilterKind::lowpass, .frequency = draws.uniform(20.0, 400.0)},
                        {.kind = loop::FilterKind::biquad, .b = {0.3, 0.2, 0.0}, .a = {-0.4, 0.1}}};
    if (draws.chance(0.3))
      blocks.observer = {.bandwidth = draws.uniform(2.0, 40.0), .inertia = p.plant.inertia};
  }

  testing::Draws draws;
  trial::TrialParameters p{};
};

TEST_EACH_SEED(HeldAxis, StandsStill) {
  double begin = 0.0, farthest = 0.0, torque = 0.0;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& r) {
    if (r.k == 0) begin = r.load_theta;
    farthest = std::max({farthest, std::abs(r.theta), std::abs(r.load_theta - begin)});
    torque = r.torque;
  };
  trial::run_trial(p, observers);
  EXPECT_LT(farthest, 1e-9);

  // By the definition: what the load gets from the coupling, and what is left for the contact.
  const double at = p.initial.position;
  const auto& ripple = p.load_side.disturbance.ripple.front();
  const double pushed =
      p.load_side.disturbance.torque + ripple.amplitude * std::sin(begin + at + ripple.phase);
  double error = 0.0, slope = 0.0;
  for (const auto& wave : p.load_side.error) {
    error += wave.amplitude * std::sin(wave.periods * at + wave.phase);
    slope += wave.amplitude * wave.periods * std::cos(wave.periods * at + wave.phase);
  }
  const double twist = error - begin;
  const double stretch = std::copysign(std::max(std::abs(twist) - 0.5 * p.plant.load.gap, 0.0), twist);
  EXPECT_NEAR(p.plant.load.stiffness * stretch, -pushed, 1e-9);
  const double held = p.disturbance.torque + (1.0 + slope) * pushed;
  const friction::FrictionParameters& contact = p.friction.uniform;
  const bool yields_early = p.friction.model == friction::FrictionModel::dahl;
  const double limit = contact.breakaway * (yields_early ? contact.coulomb_ratio : 1.0);
  const bool carries = p.friction.model != friction::FrictionModel::none && std::abs(held) < limit;
  EXPECT_NEAR(torque, carries ? 0.0 : -held, 1e-9);
}

}  // namespace
}  // namespace zerocount::testing
