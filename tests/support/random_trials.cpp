#include "tests/support/random_trials.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"
#include "tests/support/draws.hpp"

namespace zerocount::testing {

namespace {

std::shared_ptr<const friction::Profile> random_profile(Draws& draws, double mean, double variation) {
  auto profile = std::make_shared<friction::Profile>();
  const auto harmonics = static_cast<std::size_t>(draws.integer(1, 60));
  const double size = std::sqrt(3.0 / static_cast<double>(harmonics));
  profile->cosine.push_back(0.0);
  profile->sine.push_back(0.0);
  for (std::size_t m = 1; m <= harmonics; ++m) {
    profile->cosine.push_back(size * draws.uniform(-1.0, 1.0));
    profile->sine.push_back(size * draws.uniform(-1.0, 1.0));
  }
  profile->marginal = friction::Marginal::lognormal;
  profile->location = numerics::log(mean);
  profile->scale = variation;
  return profile;
}

friction::FrictionAlongRotor random_friction(Draws& draws) {
  friction::FrictionAlongRotor friction;
  friction::FrictionParameters& f = friction.uniform;
  f.k1 = draws.uniform(80.0, 140.0);
  f.k2 = draws.uniform(300.0, 1000.0);
  f.beta = draws.log_uniform(3e4, 6e5);
  f.alpha = draws.chance(0.1) ? 0.0 : draws.log_uniform(0.05, 5.0);
  constexpr double exponents[] = {1.0, 1.5, 2.0, 3.0};
  f.n = exponents[draws.integer(0, 3)];
  // At 0.02 N m, the torque of a move of some tens of counts, the creep limit is then around that of n = 2, λ
  // = 10.
  f.lambda = numerics::pow(0.02, f.n) / draws.log_uniform(1e-5, 1.6e-4);
  f.breakaway = draws.uniform(0.15, 0.35);
  f.coulomb_ratio = draws.chance(0.1) ? 1.0 : draws.uniform(0.5, 1.0);
  f.stribeck_velocity = draws.log_uniform(3e-3, 3e-2);
  if (draws.chance(0.25))
    friction.profiled.push_back({&friction::FrictionParameters::k1, random_profile(draws, f.k1, 0.1)});
  if (draws.chance(0.25))
    friction.profiled.push_back({&friction::FrictionParameters::k2, random_profile(draws, f.k2, 0.1)});
  if (draws.chance(0.25)) {
    friction.profiled.push_back(
        {&friction::FrictionParameters::breakaway, random_profile(draws, f.breakaway, 0.1)});
  }
  return friction;
}

/// A random delay of up to `most` samples; in half of the cases a whole number.
double random_delay(Draws& draws, double most) {
  const double delay = draws.uniform(0.0, most);
  return draws.chance(0.5) ? std::round(delay) : delay;
}

void choose_loop(Draws& draws, TrialKind kind, trial::TrialParameters& p) {
  loop::ControllerParameters& c = p.controller;
  c.sample_rate = draws.chance(0.7) ? 2000.0 : draws.uniform(1000.0, 5000.0);
  c.kp = draws.chance(0.5) ? 0.0 : draws.uniform(0.0, 6e-4);
  c.kd = draws.chance(0.7) ? 0.0 : draws.uniform(0.0, 4e-4);
  if (draws.chance(0.25)) c.delay = random_delay(draws, 3.0);
  c.anti_windup = draws.chance(0.8) ? loop::AntiWindup::clamp : loop::AntiWindup::none;
  p.dac.bits = draws.chance(0.7) ? 12 : static_cast<int>(draws.integer(10, 18));
  p.dac.resolution = draws.chance(0.7) ? 2.4e-4 : 0.4915 / std::ldexp(1.0, p.dac.bits - 1);
  const auto moves = draws.integer(1, 3);
  for (std::int64_t move = 0; move < moves; ++move)
    p.command.targets.push_back(draws.sign() * draws.integer(move == 0 ? 1 : 0, 30));
  switch (kind) {
    case TrialKind::calm:
      c.ki = draws.uniform(5e-6, 4.5e-5);
      p.command.hold = draws.uniform(0.1, 0.5);
      return;
    case TrialKind::ringing:
      c.ki = draws.log_uniform(5e-5, 2.5e-4);
      p.command.hold = draws.uniform(0.05, 0.2);
      return;
    case TrialKind::breaking_away:
      c.ki = draws.log_uniform(2e-5, 6e-4);
      p.command.hold = draws.uniform(0.05, 0.15);
      for (std::int64_t& target : p.command.targets) target = draws.sign() * draws.integer(100, 8000);
      return;
    default:
      return;  // chosen elsewhere
  }
}

/// A random machine that has nothing in common with the paper's: every number varies over orders of
/// magnitude, and the gains are scaled to stay near the stability bounds.
trial::TrialParameters unlike_the_paper(Draws& draws) {
  trial::TrialParameters p;
  p.plant = {draws.log_uniform(5e-5, 5e-2), draws.log_uniform(0.01, 3.0),
             draws.chance(0.3) ? 0.0 : draws.log_uniform(1e-4, 0.1)};
  friction::FrictionParameters& f = p.friction.uniform;
  f.k1 = draws.log_uniform(10.0, 2000.0);
  f.k2 = draws.chance(0.15) ? 0.0 : draws.log_uniform(10.0, 20000.0);
  f.beta = draws.log_uniform(1e3, 3e6);
  f.alpha = draws.chance(0.2) ? 0.0 : draws.log_uniform(0.01, 60.0);
  f.lambda = draws.log_uniform(0.1, 1e4);
  constexpr double exponents[] = {1.0, 1.2, 1.5, 2.0, 2.7, 3.0};
  f.n = exponents[draws.integer(0, 5)];
  f.breakaway = draws.log_uniform(0.005, 0.5);
  f.coulomb_ratio = draws.chance(0.25) ? 1.0 : draws.uniform(0.2, 1.0);
  f.stribeck_velocity = draws.log_uniform(1e-4, 3.0);
  p.encoder.fine = std::floor(draws.log_uniform(1e4, 1e7));
  p.dac.bits = static_cast<int>(draws.integer(8, 16));
  p.dac.resolution = std::ldexp(1.0, -p.dac.bits);

  loop::ControllerParameters& c = p.controller;
  c.sample_rate = std::floor(draws.log_uniform(100.0, 30000.0));
  c.delay = random_delay(draws, 2.0);
  c.anti_windup = draws.chance(0.25) ? loop::AntiWindup::none : loop::AntiWindup::clamp;
  const double count = 2.0 * std::numbers::pi / p.encoder.fine;
  const double lowest_bound =
      p.plant.presliding_damping * f.k1 / p.plant.inertia * count / c.sample_rate / 2.0;
  c.ki = lowest_bound * draws.log_uniform(0.05, 3.0);
  c.kp = draws.chance(0.5) ? 0.0 : f.k1 * count * draws.log_uniform(0.1, 2.0);
  c.kd = draws.chance(0.7)
             ? 0.0
             : p.plant.presliding_damping * count * c.sample_rate * draws.log_uniform(0.01, 0.3);
  const std::int64_t farthest = draws.chance(0.25) ? 3000 : 40;
  p.command = {{draws.integer(-farthest, farthest), draws.integer(-farthest, farthest)},
               150.0 / c.sample_rate};
  p.initial = {draws.uniform(0.0, 1.0), 0.0, draws.chance(0.7) ? 0.0 : draws.log_uniform(1e-8, 1e-5),
               draws.chance(0.7) ? 0.0 : draws.uniform(-0.9, 0.9) * f.breakaway};
  return p;
}

trial::TrialParameters like_the_paper(Draws& draws, TrialKind kind) {
  trial::TrialParameters p;
  p.plant.inertia = draws.uniform(4e-4, 8e-4);
  p.plant.presliding_damping = draws.uniform(0.1, 0.4);
  p.plant.sliding_damping = draws.chance(0.1) ? 0.0 : draws.log_uniform(1e-4, 1e-2);
  p.friction = random_friction(draws);
  choose_loop(draws, kind, p);
  p.initial.encoder_phase = draws.chance(0.15) ? 0.0 : draws.uniform(0.0, 1.0);
  p.initial.position = draws.uniform(0.0, 6.283185307179586);
  p.initial.hardening = draws.chance(0.6) ? 0.0 : draws.log_uniform(1e-7, 1e-4);
  p.initial.preload = draws.chance(0.5) ? 0.0 : draws.sign() * draws.log_uniform(1e-3, 0.12);
  return p;
}

trial::TrialParameters any_like_the_paper(Draws& draws) {
  return like_the_paper(draws, static_cast<TrialKind>(draws.integer(0, 2)));
}

trial::TrialParameters any_machine(Draws& draws) {
  return draws.chance(0.25) ? unlike_the_paper(draws) : any_like_the_paper(draws);
}

/// A random trial with gains at which the torque exceeds the breakaway torque again and again (hunting).
trial::TrialParameters hunting(Draws& draws) {
  trial::TrialParameters p = any_like_the_paper(draws);
  p.friction.model = friction::FrictionModel::coulomb;
  p.controller.ki = draws.log_uniform(1e-4, 2e-3);
  p.command.hold = draws.uniform(0.1, 0.3);
  p.initial.integral = draws.chance(0.5) ? 0.0 : draws.uniform(-0.3, 0.3);
  return p;
}

trial::TrialParameters amplified(Draws& draws) {
  trial::TrialParameters p = draws.chance(0.3) ? hunting(draws) : any_machine(draws);
  if (p.friction.model == friction::FrictionModel::presliding && draws.chance(0.2)) {
    p.friction.model = friction::FrictionModel::spring;
  }
  p.amplifier.bandwidth = p.controller.sample_rate * draws.log_uniform(0.01, 10.0);
  return p;
}

trial::TrialParameters arriving(Draws& draws) {
  trial::TrialParameters p = any_machine(draws);
  p.friction.model = static_cast<friction::FrictionModel>(draws.chance(0.6) ? 0 : draws.integer(1, 2));
  p.initial.mode = draws.chance(0.5) ? trial::InitialMode::slide : trial::InitialMode::stick;
  const double breakaway = p.friction.uniform.breakaway;
  p.initial.velocity = draws.sign() * draws.log_uniform(0.01, 3.0) * breakaway / p.plant.presliding_damping;
  p.initial.integral = draws.chance(0.5) ? 0.0 : draws.uniform(-0.8, 0.8) * breakaway;
  return p;
}

trial::TrialParameters remembering(Draws& draws) {
  trial::TrialParameters p = any_machine(draws);
  const double breakaway = friction::friction_at(p.friction, p.initial.position).breakaway;
  p.initial.history.reversals = static_cast<int>(draws.integer(1, draws.chance(0.8) ? 12 : 300));
  p.initial.history.torque = breakaway * draws.uniform(0.02, 0.95);
  p.randomness.trial = static_cast<std::uint64_t>(draws.integer(0, 1'000'000));
  p.randomness.history = {static_cast<std::uint32_t>(draws.integer(0, 0xffffffff)), 17};
  return p;
}

trial::TrialParameters loaded(Draws& draws) {
  trial::TrialParameters p = draws.chance(0.2) ? arriving(draws) : any_machine(draws);
  if (p.friction.model != friction::FrictionModel::spring && draws.chance(0.2))
    p.friction.model = friction::FrictionModel::spring;
  if (draws.chance(0.2)) p.amplifier.bandwidth = p.controller.sample_rate * draws.log_uniform(0.05, 2.0);
  motion::LoadParameters& load = p.plant.load;
  load.inertia = p.plant.inertia * draws.log_uniform(0.02, 5.0);
  const double reduced = p.plant.inertia * load.inertia / (p.plant.inertia + load.inertia);
  const double resonance = 2.0 * std::numbers::pi * p.controller.sample_rate * draws.log_uniform(0.02, 2.0);
  load.stiffness = reduced * resonance * resonance;
  load.damping = 2.0 * reduced * resonance * draws.log_uniform(0.003, 0.5);
  load.encoder = draws.chance(0.5) ? motion::EncoderPlace::load : motion::EncoderPlace::motor;
  return p;
}

}  // namespace

trial::TrialParameters random_trial(TrialKind kind, std::uint64_t index) {
  Draws draws(20020721 + 1'000'003 * static_cast<std::uint64_t>(kind) + 7919 * index);
  switch (kind) {
    case TrialKind::calm:
    case TrialKind::ringing:
    case TrialKind::breaking_away:
      return like_the_paper(draws, kind);
    case TrialKind::unlike_the_paper:
      return unlike_the_paper(draws);
    case TrialKind::spring_alone: {
      trial::TrialParameters p = any_like_the_paper(draws);
      p.friction.model = friction::FrictionModel::spring;
      return p;
    }
    case TrialKind::coulomb:
      return hunting(draws);
    case TrialKind::amplified:
      return amplified(draws);
    case TrialKind::arriving:
      return arriving(draws);
    case TrialKind::remembering:
      return remembering(draws);
    case TrialKind::loaded:
      return loaded(draws);
  }
  return {};
}

}  // namespace zerocount::testing
