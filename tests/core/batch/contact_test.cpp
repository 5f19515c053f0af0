// The contact in the lanes: what it finds at the start, where it forms anew, and what it may be without.
#include "tests/core/batch/batch_agreement.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// A friction parameter that varies along the rotor like cos(θ), with its own phase, so that no two
/// parameters vary alike.
std::shared_ptr<const friction::Profile> wave(double mean, double variation, double phase) {
  return std::make_shared<const friction::Profile>(friction::Profile{friction::Marginal::lognormal,
                                                                     std::log(mean),
                                                                     variation,
                                                                     {0.0, std::cos(phase), 0.3},
                                                                     {0.0, std::sin(phase), -0.4}});
}

TEST(BatchContact, TakesItsParametersFromTheProfileWhereItSticks) {
  using P = friction::FrictionParameters;
  double P::*const profiled[] = {&P::k1,     &P::k2,        &P::beta,          &P::alpha,
                                 &P::lambda, &P::breakaway, &P::coulomb_ratio, &P::stribeck_velocity};
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 160; ++i) {
    // Moves that slide far, at gains that let the rotor stick and settle again.
    trials.push_back(trial_for_lanes(i % 2 == 0 ? TrialKind::breaking_away : TrialKind::calm, 90000 + i));
    trial::TrialParameters& p = trials.back();
    p.friction.profiled.clear();
    P& f = p.friction.uniform;
    f.coulomb_ratio = 0.7;
    for (std::size_t j = 0; j < std::size(profiled); ++j) {
      const bool has_one = i % 9 == 8 || j == i % 9;
      const double variation = profiled[j] == &P::coulomb_ratio ? 0.05 : 0.15;
      if (has_one)
        p.friction.profiled.push_back({profiled[j], wave(f.*profiled[j], variation, static_cast<double>(i))});
    }
    p.initial.position = 0.04 * static_cast<double>(i);
  }
  const BatchAgreement agreement = expect_agreement_in_lanes(trials, "profiles");
  EXPECT_GT(agreement.slides, 70);
  EXPECT_GT(agreement.trials - agreement.slides, 50);
}

TEST(BatchContact, DrawsNewParametersWhenItSticks) {
  using P = friction::FrictionParameters;
  double P::*const drawn[] = {&P::k1,
                              &P::k2,
                              &P::beta,
                              &P::alpha,
                              &P::lambda,
                              &P::n,
                              &P::breakaway,
                              &P::coulomb_ratio,
                              &P::stribeck_velocity};
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 160; ++i) {
    trials.push_back(trial_for_lanes(i % 2 == 0 ? TrialKind::breaking_away : TrialKind::calm, 96000 + i));
    trial::TrialParameters& p = trials.back();
    p.friction.profiled.clear();
    P& f = p.friction.uniform;
    f.coulomb_ratio = 0.7;
    for (std::size_t j = 0; j < std::size(drawn); ++j) {
      if (i % 10 != 9 && j != i % 10) continue;
      const double spread = drawn[j] == &P::coulomb_ratio ? 0.1 : 0.4;
      const double middle = f.*drawn[j];
      const random::RandomStream stream{.key = {static_cast<std::uint32_t>(j), 5}, .stream = 0};
      p.friction.per_contact.push_back({drawn[j], [=](std::uint64_t contact) {
                                          const double u = friction::contact_uniform(stream, i, contact);
                                          return middle * (1.0 + spread * (u - 0.5));
                                        }});
    }
  }
  const BatchAgreement agreement = expect_agreement_in_lanes(trials, "contacts");
  EXPECT_GT(agreement.slides, 70);
}

TEST(BatchContact, StartsWithPreloadHistoryAndHardening) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 150; ++i) {
    trials.push_back(trial_for_lanes(i % 3 == 0 ? TrialKind::ringing : TrialKind::calm, 91000 + i));
    trial::TrialParameters& p = trials.back();
    const double breakaway = friction::friction_at(p.friction, p.initial.position).breakaway;
    p.initial.preload = (i % 2 == 0 ? 1.0 : -1.0) * breakaway * 0.05 * static_cast<double>(i % 19);
    p.initial.hardening = i % 5 == 0 ? 1e-6 * static_cast<double>(i) : 0.0;
    p.initial.history = {static_cast<int>(i % 4 == 0 ? 0 : 1 + (7 * i) % 300), 0.6 * breakaway};
    p.randomness.trial = i;
    p.randomness.history = {11, 17};
  }
  const BatchAgreement agreement = expect_agreement_in_lanes(trials, "preload, history and hardening");
  EXPECT_GT(agreement.trials - agreement.slides, 50);
}

TEST(BatchContact, AgreesIfItMovesOrSlidesAtTheStart) {
  for (const trial::InitialMode mode : {trial::InitialMode::stick, trial::InitialMode::slide}) {
    std::vector<trial::TrialParameters> trials;
    for (std::uint64_t i = 0; i < 120; ++i) {
      trials.push_back(trial_for_lanes(TrialKind::calm, 92000 + i));
      trial::TrialParameters& p = trials.back();
      p.initial.mode = mode;
      p.initial.velocity = (i % 2 == 0 ? 1.0 : -1.0) * std::exp(-6.0 + 0.06 * static_cast<double>(i));
      p.initial.integral = i % 3 == 0 ? 0.0 : 0.001 * static_cast<double>(i);
    }
    const BatchAgreement agreement = expect_agreement_in_lanes(
        trials, mode == trial::InitialMode::slide ? "sliding at the start" : "moving at the start");
    EXPECT_GT(agreement.slides, mode == trial::InitialMode::slide ? 119 : 20);
  }
}

TEST(BatchContact, AgreesWithoutCreep) {
  for (const bool by_model : {true, false}) {
    std::vector<trial::TrialParameters> trials;
    for (std::uint64_t i = 0; i < 90; ++i) {
      constexpr TrialKind kinds[] = {TrialKind::calm, TrialKind::ringing, TrialKind::breaking_away};
      trials.push_back(trial_for_lanes(kinds[i % 3], 93000 + i));
      trial::TrialParameters& p = trials.back();
      if (by_model) {
        p.friction.model = friction::FrictionModel::spring;
      } else {
        p.friction.model = friction::FrictionModel::presliding;
        p.friction.uniform.alpha = 0.0;
      }
    }
    expect_agreement_in_lanes(trials, by_model ? "the spring alone" : "alpha 0");
  }
}

/// Damping ranges from very weak, where an error lasts for thousands of samples, to overdamped, where an
/// error decays as slowly as the elongation relaxes.
TEST(BatchContact, AgreesForAnyDamping) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 180; ++i) {
    constexpr TrialKind kinds[] = {TrialKind::calm, TrialKind::ringing, TrialKind::breaking_away};
    trials.push_back(trial_for_lanes(kinds[i % 3], 97000 + i));
    trial::TrialParameters& p = trials.back();
    const friction::FrictionParameters& f = p.friction.uniform;
    const double damping_ratio = std::exp(-6.0 + 0.06 * static_cast<double>(i));  // to 115
    p.plant.presliding_damping = 2.0 * damping_ratio * std::sqrt((f.k1 + f.k2) * p.plant.inertia);
  }
  expect_agreement_in_lanes(trials, "damping");
}

trial::TrialParameters creeping_trial(std::uint64_t index, double alpha) {
  trial::TrialParameters p = trial_for_lanes(TrialKind::calm, 94000 + index);
  friction::FrictionParameters& f = p.friction.uniform;
  f.alpha = alpha;
  f.lambda *= std::exp(0.02 * static_cast<double>((37 * index) % 200) - 2.0);
  p.friction.profiled.clear();
  return p;
}

/// Creep ranges from none to creep that is finished within some tens of samples.
TEST(BatchContact, AgreesAtAnyCreepRate) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 200; ++i) {
    trials.push_back(creeping_trial(i, std::exp(-5.0 + 0.036 * static_cast<double>(i))));  // to 9 /s
  }
  expect_agreement_in_lanes(trials, "creep");
}

/// Creep is faster than the decay of the rotor's oscillation: then nothing is at rest until creep ends, and
/// rounding has a say in how many of the last reversals are remembered.
TEST(BatchContact, AgreesIfCreepIsFasterThanTheOscillation) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 100; ++i) {
    trials.push_back(creeping_trial(i, std::exp(3.0 + 0.03 * static_cast<double>(i))));  // to 400 /s
  }
  const BatchAgreement agreement = agreement_of(trials, "fast creep");
  std::cout << "fast creep: " << agreement.figures() << "\n";
  for (const std::string& failure : agreement.failures) std::cout << failure << "\n";
  EXPECT_EQ(agreement.other_counts, 0);
  EXPECT_EQ(agreement.other_measures, 0);
  EXPECT_LE(agreement.other_depth + agreement.depth_by_steps, 5);
}

/// Softening of the spring ranges from none (the spring is linear) to so much that nearly every step has an
/// event.
TEST(BatchContact, AgreesForAnySoftening) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 150; ++i) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 95000 + i));
    friction::FrictionParameters& f = trials.back().friction.uniform;
    f.k2 = i % 5 == 0 ? 0.0 : 200.0 * static_cast<double>(i % 50);
    f.beta = std::exp(8.0 + 0.05 * static_cast<double>(i));  // 3e3 to 5e6 /rad
    trials.back().friction.profiled.clear();
  }
  expect_agreement_in_lanes(trials, "softening");
}

// Where the disturbance exceeds the breakaway of an axis with a second mass, its integral holds it.
TEST(BatchContact, TheIntegralHoldsTheLoadBeyondBreakaway) {
  trial::TrialParameters p;
  p.friction.model = friction::FrictionModel::lugre;
  p.friction.uniform.breakaway = 0.05;
  p.plant.load = {.inertia = 1e-3, .stiffness = 1e3, .damping = 0.01};
  p.disturbance.torque = 0.3;
  p.initial.holding = true;
  p.controller.ki = 0.0;
  p.command = {.targets = {0}, .hold = 0.1};
  EXPECT_NEAR(run_batch({p}).front().outcome.moves.front().holding_torque, -0.3, p.dac.resolution);
}

// The blocks of the controller in the lanes.

std::vector<trial::TrialParameters> trials_with(BlockKind kind, int count) {
  RandomBlocks draw(90000 + static_cast<std::uint64_t>(kind));
  std::vector<trial::TrialParameters> trials;
  for (int i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    trials.push_back(trial_for_lanes(i % 4 == 0 ? TrialKind::ringing : TrialKind::calm, 83000 + number));
    trial::TrialParameters& p = trials.back();
    p.controller.blocks = draw.blocks(kind, p.controller.sample_rate);
    if (kind == BlockKind::all && i % 3 == 0)
      p.controller.dither = {draw.log_uniform(1e-5, 3e-3),
                             p.controller.sample_rate * draw.uniform(0.05, 0.5)};
    p.dac.sigma_delta = kind == BlockKind::all && i % 5 == 0;
    if (i % 7 == 0) p.disturbance.torque = draw.uniform(-0.05, 0.05);
    p.initial.holding = i % 14 == 0 && p.initial.preload == 0.0 && p.initial.history.reversals == 0;
    if (i % 3 == 0) p.command.targets.push_back(p.command.targets.back() + 7);
    // Such that some arrive and rest.
    if (i % 2 == 0) {
      p.controller.ki = 1e-5;
      p.controller.kp = p.controller.kd = 0.0;
    }
  }
  return trials;
}

TEST(BatchBlocks, AgreeWithTheReference) {
  std::vector<trial::TrialParameters> all;
  for (int kind = 0; kind < block_kinds; ++kind) {
    const std::vector<trial::TrialParameters> trials = trials_with(static_cast<BlockKind>(kind), 60);
    all.insert(all.end(), trials.begin(), trials.end());
    const BatchAgreement agreement = agreement_of(trials, block_kind_names[kind]);
    EXPECT_GT(agreement.trials - agreement.slides, 40) << block_kind_names[kind];
  }
  expect_agreement_in_lanes(all, "blocks");
}

// Trials with blocks beside trials without, in few lanes that all of them go through.
TEST(BatchBlocks, AgreeBesideTrialsWithoutBlocks) {
  std::vector<trial::TrialParameters> trials;
  for (int kind = 0; kind < block_kinds; ++kind) {
    for (const trial::TrialParameters& p : trials_with(static_cast<BlockKind>(kind), 8)) trials.push_back(p);
  }
  std::vector<trial::TrialParameters> mixed;
  for (std::size_t i = 0; i < trials.size(); ++i) mixed.push_back(trials[i * 37 % trials.size()]);
  expect_independent(mixed);
}

// A deadband keeps the torque where the error is 0, so that a lane goes on from event to event; what
// remembers more than the integral is sampled every time.
TEST(BatchBlocks, AMemoryThatFadesIsNotSkipped) {
  std::vector<trial::TrialParameters> trials;
  for (const double leak : {0.02, 0.2, 2.0}) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 84000));
    trial::TrialParameters& p = trials.back();
    p.controller.ki = 1e-5;
    p.controller.kp = p.controller.kd = 0.0;
    p.controller.blocks.integrator_leak = leak;
    p.command.hold = 2.0;
  }
  expect_agreement_in_lanes(trials, "leak");
}

// The control loop in the lanes: delay, gains, anti-windup, and converters of any word.

TEST(BatchLoop, AgreesForDelayedTorques) {
  for (const int delay : {0, 1, 2, 3, 4, 5, 64}) {
    std::vector<trial::TrialParameters> trials;
    for (std::uint64_t i = 0; i < 30; ++i) {
      trials.push_back(trial_for_lanes(i % 5 == 0 ? TrialKind::ringing : TrialKind::calm, 80000 + i));
      trial::TrialParameters& p = trials.back();
      p.controller.delay = delay;
      if (i % 2 == 0) {  // such that some arrive and rest
        p.controller.ki = delay < 10 ? 1e-5 : 1e-6;
        p.controller.kp = p.controller.kd = 0.0;
        p.command.hold = 1.0;
      }
    }
    const BatchAgreement agreement =
        expect_agreement_in_lanes(trials, "delay " + std::to_string(delay) + " samples");
    EXPECT_GT(agreement.trials - agreement.slides, 5);
  }
}

TEST(BatchLoop, AgreesWithProportionalAndDerivativeGains) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 120; ++i) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 81000 + i));
    loop::ControllerParameters& c = trials.back().controller;
    c.kp = 1e-4 * static_cast<double>(i % 7);
    c.kd = 5e-5 * static_cast<double>(i % 5);
    if (i % 12 == 0) c.ki = 0.0;  // which mostly ends in a limit cycle
  }
  const BatchAgreement agreement = expect_agreement_in_lanes(trials, "kp, ki and kd");
  EXPECT_GT(agreement.trials - agreement.slides, 60);
}

/// Converter words range from so short that torques are clipped to so fine that no code stays the same for
/// long.
TEST(BatchLoop, AgreesForAnyConverterWordLength) {
  std::vector<trial::TrialParameters> trials;
  int clipped = 0;
  for (std::uint64_t i = 0; i < 120; ++i) {
    trials.push_back(trial_for_lanes(i % 2 == 0 ? TrialKind::calm : TrialKind::ringing, 82000 + i));
    trial::TrialParameters& p = trials.back();
    p.dac.bits = i % 3 == 0 ? 6 : (i % 3 == 1 ? 12 : 24);
    p.dac.resolution = i % 3 == 0 ? 1e-3 : (i % 3 == 1 ? 1e-4 : 5e-8);
    p.controller.anti_windup = i % 4 < 2 ? loop::AntiWindup::clamp : loop::AntiWindup::none;
    p.initial.integral = i % 5 == 0 ? 0.05 : 0.0;
    for (const trial::MoveOutcome& move : trial::run_trial(p).moves) clipped += move.saturated;
  }
  expect_agreement_in_lanes(trials, "converters");
  EXPECT_GT(clipped, 20);
}

// Moves in the lanes: many of them, short ones, and how they are judged.

class Choices {
 public:
  explicit Choices(std::uint64_t seed) : engine_(seed) {}
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::mt19937_64 engine_;
};

trial::TrialParameters with_targets(trial::TrialParameters p, Choices& choices) {
  p.command.targets.clear();
  const std::int64_t moves = choices.integer(2, 7);
  for (std::int64_t move = 0; move < moves; ++move) {
    const bool stay = move > 0 && choices.integer(0, 3) == 0;
    p.command.targets.push_back(stay ? p.command.targets.back() : choices.integer(-30, 30));
  }
  return p;
}

TEST(BatchMoves, FollowOneAnother) {
  Choices choices(1);
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 120; ++i) {
    const TrialKind kind = i % 3 == 0 ? TrialKind::ringing : TrialKind::calm;
    trials.push_back(with_targets(trial_for_lanes(kind, 70000 + i), choices));
    trials.back().command.hold = static_cast<double>(choices.integer(60, 600)) / 2000.0;
  }
  const BatchAgreement agreement = expect_agreement_in_lanes(trials, "several moves");
  EXPECT_GT(agreement.trials - agreement.slides, 50);
}

TEST(BatchMoves, MayLastOneSample) {
  Choices choices(2);
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 120; ++i) {
    trials.push_back(with_targets(trial_for_lanes(TrialKind::calm, 71000 + i), choices));
    trial::TrialParameters& p = trials.back();
    p.controller.sample_rate = 2000.0;
    p.command.hold = static_cast<double>(choices.integer(1, 12)) / 2000.0;
    p.verdict.dwell = static_cast<double>(choices.integer(1, 3)) / 2000.0;
    p.verdict.window = static_cast<double>(choices.integer(1, 3)) / 2000.0;
  }
  expect_agreement_in_lanes(trials, "short moves");
}

/// Dwell and window range from one sample to the whole move. Some moves arrive at their first sample.
TEST(BatchMoves, AreJudgedByAnyDwellAndWindow) {
  Choices choices(3);
  std::vector<trial::TrialParameters> trials;
  int arrived = 0, jerks = 0;
  for (std::uint64_t i = 0; i < 150; ++i) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 72000 + i));
    trial::TrialParameters& p = trials.back();
    p.controller.sample_rate = 2000.0;
    p.controller.ki = std::min(p.controller.ki, 3e-5);
    if (i % 3 == 0) p.command.targets.front() = 0;
    const std::int64_t samples = choices.integer(100, 2000);
    p.command.hold = static_cast<double>(samples) / 2000.0;
    p.verdict.dwell = static_cast<double>(choices.integer(1, i % 2 == 0 ? 10 : samples)) / 2000.0;
    p.verdict.window = static_cast<double>(choices.integer(1, i % 2 == 0 ? 10 : samples)) / 2000.0;
    for (const trial::MoveOutcome& move : trial::run_trial(p).moves) {
      arrived += move.arrived;
      jerks += move.jerk_count > 0;
    }
  }
  expect_agreement_in_lanes(trials, "dwell and window");
  EXPECT_GT(arrived, 50);
  EXPECT_GT(jerks, 30);
}

/// Jumps at rest go over thousands of samples; a move of more than a million is one of them.
TEST(BatchMoves, MayBeLong) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 4; ++i) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 73000 + i));
    trials.back().controller.ki = 2e-5;
    trials.back().controller.sample_rate = 2000.0;
    trials.back().command.targets = {static_cast<std::int64_t>(5 + 5 * i)};
    trials.back().command.hold = 150.0;
  }
  expect_agreement_in_lanes(trials, "long moves");
}

}  // namespace
}  // namespace zerocount::testing
