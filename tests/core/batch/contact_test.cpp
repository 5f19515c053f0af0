// The contact in the lanes: what it finds at the start, where it forms anew, and what it may be without.
#include "tests/core/batch/expect_agreement.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// cos(θ) with its own phase, so that no two parameters change alike.
std::shared_ptr<const friction::Profile> wave(double mean, double variation, double phase) {
  return std::make_shared<const friction::Profile>(friction::Profile{friction::Marginal::lognormal,
                                                                     std::log(mean),
                                                                     variation,
                                                                     {0.0, std::cos(phase), 0.3},
                                                                     {0.0, std::sin(phase), -0.4}});
}

TEST(BatchContact, TakesEveryParameterFromItsProfileWhereItSticks) {
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

TEST(BatchContact, DrawsItsParametersAnewWhereItSticks) {
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

TEST(BatchContact, RemembersWhatWasBeforeTheStart) {
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

TEST(BatchContact, MayBeMovingOrSlidingAtTheStart) {
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

TEST(BatchContact, MayBeWithoutCreep) {
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

/// From hardly damped, where an error lasts for thousands of samples, to overdamped, where it dies out as
/// slowly as the elongation relaxes.
TEST(BatchContact, MayBeDampedAtAnyRate) {
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

/// Creep from none to what is over within some tens of samples.
TEST(BatchContact, CreepsAtAnyRate) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 200; ++i) {
    trials.push_back(creeping_trial(i, std::exp(-5.0 + 0.036 * static_cast<double>(i))));  // to 9 /s
  }
  expect_agreement_in_lanes(trials, "creep");
}

/// Creep is faster than the decay of the rotor's oscillation: then nothing is at rest until creep ends, and
/// rounding has a say in how many of the last reversals are remembered.
TEST(BatchContact, CreepsFasterThanItSwings) {
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

/// Without softening the spring is linear; with much of it there is hardly a step without an event.
TEST(BatchContact, SoftensByAnyAmount) {
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

}  // namespace
}  // namespace zerocount::testing
