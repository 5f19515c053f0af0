#include "tests/core/trial/widened_trials.hpp"

#include <cmath>
#include <random>

namespace zerocount::testing {
namespace {

/// Random numbers that are the same on every platform; the distributions of the C++ standard library are not.
class WidenedDraws {
 public:
  explicit WidenedDraws(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double sometimes(double value) { return chance(0.5) ? value : 0.0; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }
  random::RandomKey key() {
    const std::uint32_t first = word();
    return {first, word()};
  }

 private:
  std::mt19937_64 engine_;
};

loop::EncoderErrors encoder_errors(WidenedDraws& draws) {
  loop::EncoderErrors errors;
  errors.eccentricity = draws.sometimes(draws.log_uniform(1e-6, 1e-3));
  errors.eccentricity_angle = draws.uniform(-7.0, 7.0);
  errors.interpolation = draws.sometimes(draws.uniform(0.05, 1.0));
  errors.interpolation_period = draws.chance(0.5) ? 4.0 : draws.uniform(2.0, 50.0);
  errors.noise = draws.sometimes(draws.log_uniform(0.05, 1.0));
  errors.missed = draws.sometimes(draws.log_uniform(1e-4, 3e-2));
  return errors;
}

loop::EncoderParameters encoders(WidenedDraws& draws) {
  loop::EncoderParameters encoders;
  if (draws.chance(0.3)) {
    encoders.fine = std::floor(draws.uniform(8e5, 2.5e6));
    encoders.coarse = draws.chance(0.2) ? encoders.fine : std::floor(draws.log_uniform(3e4, 4e5));
  }
  if (draws.chance(0.4)) encoders.fine_errors = encoder_errors(draws);
  if (draws.chance(0.4)) encoders.coarse_errors = encoder_errors(draws);
  return encoders;
}

loop::DacParameters converter(WidenedDraws& draws) {
  loop::DacParameters dac;
  dac.bits = 10 + draws.below(5);
  dac.resolution = draws.uniform(0.3, 0.5) / std::ldexp(1.0, dac.bits - 1);
  if (draws.chance(0.5)) return dac;
  dac.offset = draws.sometimes(draws.uniform(-5e-3, 5e-3));
  dac.gain_error = draws.sometimes(draws.uniform(-0.05, 0.05));
  dac.nonlinearity = draws.sometimes(draws.uniform(-3.0, 3.0));
  dac.noise = draws.sometimes(draws.log_uniform(1e-5, 1e-3));
  return dac;
}

loop::ControllerParameters laws(WidenedDraws& draws, WidenedKind kind) {
  loop::ControllerParameters c;
  c.sample_rate = draws.chance(0.6) ? 2000.0 : draws.uniform(1500.0, 3000.0);
  c.kp = draws.sometimes(draws.uniform(0.0, 3e-4));
  c.ki = draws.log_uniform(1e-5, 6e-5);
  c.kd = draws.sometimes(draws.uniform(0.0, 2e-4));
  c.delay = static_cast<double>(draws.below(10)) / 3.0;
  c.anti_windup = draws.chance(0.6) ? loop::AntiWindup::clamp : loop::AntiWindup::none;
  c.encoder = draws.chance(0.8) ? loop::EncoderChoice::fine : loop::EncoderChoice::coarse;
  if (kind != WidenedKind::two_phases) return c;
  c.coarse.kp = draws.uniform(3e-4, 8e-4);
  c.coarse.ki = draws.log_uniform(1e-6, 1e-5);
  c.coarse.kd = draws.uniform(2e-3, 8e-3);
  c.coarse.encoder = draws.chance(0.5) ? loop::EncoderChoice::fine : loop::EncoderChoice::coarse;
  c.coarse.fine_within = draws.uniform(20.0, 150.0);
  c.coarse.fine_rate = std::floor(draws.sometimes(draws.uniform(0.0, 20.0)));
  c.coarse.fine_dwell = draws.sometimes(draws.uniform(0.0, 0.01));
  c.coarse.coarse_beyond = c.coarse.fine_within * draws.uniform(0.5, 3.0);
  return c;
}

void choose_targets(WidenedDraws& draws, WidenedKind kind, trial::CommandParameters& command) {
  const int moves = 2 + draws.below(3);
  for (int move = 0; move < moves; ++move) {
    const double size =
        kind == WidenedKind::one_phase ? draws.uniform(1.0, 40.0) : draws.log_uniform(10.0, 4000.0);
    const bool stay = move > 0 && draws.chance(0.1);
    command.targets.push_back(stay ? command.targets.back()
                                   : static_cast<std::int64_t>(draws.sign() * std::round(size)));
  }
  command.hold = kind == WidenedKind::one_phase ? draws.uniform(0.3, 0.8) : draws.uniform(0.1, 0.4);
  command.profile = {static_cast<loop::ReferenceShape>(draws.below(4) % 3), draws.log_uniform(0.05, 2.0),
                     draws.log_uniform(5.0, 200.0), draws.log_uniform(500.0, 5e4)};
}

void choose_levels(WidenedDraws& draws, double sample_rate, trial::CommandParameters& command) {
  const int moves = 2 + draws.below(3);
  for (int move = 0; move < moves; ++move) {
    const bool stay = move > 0 && draws.chance(0.1);
    command.torque.levels.push_back(stay ? command.torque.levels.back() : draws.uniform(-0.25, 0.25));
  }
  // Sometimes the way to the first level is a whole number of samples.
  command.torque.rate = draws.chance(0.3) ? std::abs(command.torque.levels[0]) * sample_rate / 64.0
                                          : draws.log_uniform(0.5, 10.0);
  command.torque.through = draws.chance(0.5) ? trial::TorquePath::dac : trial::TorquePath::exact;
  command.hold = draws.uniform(0.01, 0.1);
}

trial::InitialConditions start(WidenedDraws& draws) {
  trial::InitialConditions initial;
  initial.encoder_phase = draws.chance(0.15) ? 0.0 : draws.uniform(0.0, 1.0);
  initial.position = draws.uniform(0.0, 6.28);
  initial.hardening = draws.sometimes(draws.log_uniform(1e-7, 1e-4));
  initial.preload = draws.sometimes(draws.uniform(-0.1, 0.1));
  if (draws.chance(0.3)) initial.history = {1 + draws.below(8), draws.uniform(0.01, 0.15)};
  if (draws.chance(0.3)) initial.velocity = draws.sign() * draws.log_uniform(0.01, 0.5);
  if (draws.chance(0.5)) initial.mode = trial::InitialMode::slide;
  if (draws.chance(0.6)) initial.integral = draws.uniform(-0.1, 0.1);
  if (draws.chance(0.1)) initial.integral = draws.sign() * draws.uniform(0.5, 0.7);  // out of any range
  return initial;
}

}  // namespace

trial::TrialParameters widened_trial(WidenedKind kind, std::uint64_t index) {
  WidenedDraws draws(4711 + 1'000'003 * static_cast<std::uint64_t>(kind) + 7919 * index);
  trial::TrialParameters p;
  p.friction.uniform.k1 = draws.uniform(80.0, 140.0);
  p.friction.uniform.k2 = draws.uniform(500.0, 900.0);
  p.friction.uniform.breakaway = draws.uniform(0.18, 0.3);
  p.encoder = encoders(draws);
  p.dac = converter(draws);
  p.amplifier.bandwidth = draws.sometimes(draws.log_uniform(100.0, 3000.0));
  p.controller = laws(draws, kind);
  if (kind == WidenedKind::open_loop) {
    choose_levels(draws, p.controller.sample_rate, p.command);
  } else {
    choose_targets(draws, kind, p.command);
  }
  p.initial = start(draws);
  p.verdict = {draws.log_uniform(0.001, 0.05), draws.log_uniform(0.001, 0.05)};
  p.verdict.bands = {.limits = {0, 2, 7}, .count = 3};
  p.randomness = {draws.word(), draws.word() % 100, draws.key(), draws.key(),
                  draws.key(),  draws.key(),        draws.key(), draws.key()};
  return p;
}

}  // namespace zerocount::testing
