// The trial against an integration written apart from it, Boost.odeint with located events, in some hundred
// random trials: counts and codes are equal, θ within the promised accuracy.
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "core/trial/trial.hpp"
#include "tests/core/trial/literal_trial.hpp"
#include "tests/core/trial/widened_trials.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/odeint_motion.hpp"
#include "tests/support/odeint_trial.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

std::vector<trial::SampleRecord> records_of_trial(const trial::TrialParameters& parameters) {
  std::vector<trial::SampleRecord> records;
  trial::TrialObservers observers;
  observers.sample = [&records](const trial::SampleRecord& record) { records.push_back(record); };
  trial::run_trial(parameters, observers);
  return records;
}

struct Family {
  const char* name;
  TrialKind kind;
  std::uint64_t trials;
  std::uint64_t many;  ///< number of trials in the long test
};

// The name of the family names the test.
void PrintTo(const Family& family, std::ostream* out) {
  *out << family.name;
}

class RandomTrialAgreement : public ::testing::TestWithParam<Family> {};

void expect_odeint(const Family& family, std::uint64_t trials) {
  Agreement total;
  for (std::uint64_t index = 0; index < trials; ++index) {
    const trial::TrialParameters parameters = random_trial(family.kind, index);
    const std::string name = std::string(family.name) + " trial " + std::to_string(index);
    total.add(compare(parameters, records_of_trial(parameters), odeint_trial(parameters), name));
  }
  std::cout << family.name << ": " << total.figures() << "\n";
  for (const std::string& failure : total.failures) ADD_FAILURE() << failure;
  EXPECT_LE(total.edge_trials, static_cast<std::int64_t>(trials / 50));
  // Promised are 1e-6 count and a proportion of 1; an integrator that lost an order would show here first.
  EXPECT_LT(total.before_breakaway, 1e-7);
  EXPECT_LT(total.after_breakaway_ratio, 0.1);
}

TEST_P(RandomTrialAgreement, EqualsBoostOdeintSampleBySample) {
  expect_odeint(GetParam(), GetParam().trials);
}

TEST_P(RandomTrialAgreement, DISABLED_EqualsBoostOdeintInManyTrials) {
  expect_odeint(GetParam(), GetParam().many);
}

INSTANTIATE_TEST_SUITE_P(Seeded, RandomTrialAgreement,
                         ::testing::Values(Family{"calm", TrialKind::calm, 50, 200},
                                           Family{"ringing", TrialKind::ringing, 50, 200},
                                           Family{"breaking_away", TrialKind::breaking_away, 50, 200},
                                           Family{"unlike_the_paper", TrialKind::unlike_the_paper, 50, 200},
                                           Family{"spring_alone", TrialKind::spring_alone, 30, 60},
                                           Family{"coulomb", TrialKind::coulomb, 30, 60},
                                           Family{"amplified", TrialKind::amplified, 30, 60},
                                           Family{"arriving", TrialKind::arriving, 30, 60},
                                           Family{"remembering", TrialKind::remembering, 30, 60}));

void expect_agreement(const trial::TrialParameters& parameters, const std::string& name) {
  const Agreement agreement =
      compare(parameters, records_of_trial(parameters), odeint_trial(parameters), name);
  std::cout << name << ": " << agreement.figures() << "\n";
  for (const std::string& failure : agreement.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(agreement.edge_trials, 0);
}

TEST(TrialAgreement, HoldsOverSecondsOfCreepAndJerks) {
  trial::TrialParameters parameters;
  parameters.command = {{30}, 7.5};
  expect_agreement(parameters, "30 counts for 7.5 s");
}

// Hardened beyond any creep, the rotor really comes to rest, and its ever smaller oscillation meets the rest
// rule.
TEST(TrialAgreement, HoldsAtRestWithoutCreep) {
  trial::TrialParameters parameters;
  parameters.command = {{30, 29, 0}, 1.0};
  parameters.initial.hardening = 1e-3;
  expect_agreement(parameters, "from virgin");
  parameters.initial.preload = 0.1;
  expect_agreement(parameters, "from preload");
}

// The rotor leaves a preloaded rest only when a torque comes: rounding must not move it over an encoder edge
// at θ = 0.
TEST(TrialAgreement, StandsStillOnAnEdgeUntilTheFirstTorque) {
  trial::TrialParameters parameters;
  parameters.command = {{-2000}, 0.05};
  parameters.initial.encoder_phase = 0.0;
  parameters.controller.delay = 3;
  for (int i = -40; i <= 40; ++i) {
    parameters.initial.preload = 0.0031 * i;
    const std::vector<trial::SampleRecord> records = records_of_trial(parameters);
    for (std::size_t k = 0; k <= 3; ++k) EXPECT_EQ(records.at(k).count, 0) << parameters.initial.preload;
  }
}

// The spring by itself (α = 0), at every exponent of the creep that is off. From a preload the loops close
// where σ = 0, the one point where |σ|ⁿ is not smooth.
// Its contact is run through σ = 0 by a slide against the spring, while it creeps with n = 2.7.
TEST(TrialAgreement, HoldsIfCreepEndsAtZeroTorque) {
  expect_agreement(random_trial(TrialKind::unlike_the_paper, 510), "through zero torque");
}

TEST(TrialAgreement, HoldsWithCreepOff) {
  for (const double n : {1.0, 1.5, 2.0, 2.5, 3.0}) {
    for (const double preload : {0.03, -0.08}) {
      trial::TrialParameters parameters;
      parameters.friction.uniform.alpha = 0.0;
      parameters.friction.uniform.n = n;
      parameters.command = {{8, -40}, 0.1};
      parameters.controller.ki = 1e-4;
      parameters.initial.preload = preload;
      expect_agreement(parameters, "creep off, n = " + std::to_string(n));
    }
  }
}

// The judge of the friction loop against closed forms, before it judges anything else.

// Under a constant torque U the rotor comes to rest with the spring carrying U less the damper's proportion,
// and creep follows xh(t) = (|U|ⁿ/λ)·(1 − exp(−αt)). A stiff, well damped rotor brings the start-up to
// nothing.
TEST(OdeintMotion, CreepsExactlyAtConstantTorque) {
  trial::TrialParameters parameters;
  parameters.plant = {1e-6, 0.02, 1e-3};
  for (const double n : {1.0, 1.5, 2.0, 3.0}) {
    parameters.friction.uniform.n = n;
    parameters.friction.uniform.lambda = std::pow(0.05, n) / 2e-5;
    OdeintMotion motion(parameters);
    for (int k = 0; k < 600; ++k) motion.advance(-0.05L, 5e-4L);
    const friction::FrictionParameters& f = parameters.friction.uniform;
    const double expected = 2e-5 * -std::expm1(-f.alpha * 0.3);
    EXPECT_NEAR(static_cast<double>(motion.state()[3]) / expected, 1.0, 2e-3);
    EXPECT_DOUBLE_EQ(static_cast<double>(motion.state()[2]), -static_cast<double>(motion.state()[3]));
  }
}

// A slide without damping and with coulomb_ratio 1 has the constant friction Fs: while it lasts, uniform
// acceleration.
TEST(OdeintMotion, SlidesUniformlyUnderCoulombFriction) {
  trial::TrialParameters parameters;
  parameters.plant.sliding_damping = 0.0;
  parameters.friction.uniform.coulomb_ratio = 1.0;
  OdeintMotion motion(parameters);
  while (!motion.sliding()) motion.advance(0.45L, 1e-4L);
  const long double speed = motion.state()[1];
  const long double start = motion.theta();
  motion.advance(0.45L, 0.01L);
  const long double acceleration = (0.45L - 0.3) / 5.54e-4;
  EXPECT_NEAR(static_cast<double>(motion.state()[1]), static_cast<double>(speed + acceleration * 0.01L),
              1e-12);
  EXPECT_NEAR(static_cast<double>(motion.theta() - start),
              static_cast<double>(speed * 0.01L + acceleration * 0.00005L), 1e-13);
}

// Trials on an air bearing, with all that a loop can have: their motion by Boost.odeint under the torque that
// their drive should have, and what is told of a contact that is not there.

using Real = long double;
using State = std::array<Real, 2>;  // θ (rad), ω (rad/s)

struct FreeTrial {
  trial::TrialParameters parameters;
  std::vector<trial::SampleRecord> samples;
  trial::TrialOutcome outcome;
};

/// A random trial whose friction is removed, and sometimes its damping too.
FreeTrial free_trial(WidenedKind kind, std::uint64_t index) {
  FreeTrial trial;
  trial.parameters = widened_trial(kind, index);
  trial.parameters.friction.model = friction::FrictionModel::none;
  if (index % 3 == 0) trial.parameters.plant.presliding_damping = 0.0;
  trial::TrialObservers observers;
  observers.sample = [&trial](const trial::SampleRecord& sample) { trial.samples.push_back(sample); };
  trial.outcome = trial::run_trial(trial.parameters, observers);
  return trial;
}

template <class Check>
void for_each_free_trial(Check check) {
  for (const WidenedKind kind : {WidenedKind::two_phases, WidenedKind::one_phase, WidenedKind::open_loop}) {
    for (std::uint64_t index = 0; index < 8; ++index) {
      SCOPED_TRACE(::testing::Message() << "kind " << static_cast<int>(kind) << " trial " << index);
      check(free_trial(kind, index));
    }
  }
}

TEST(FreeTrial, FollowsItsEquationOfMotion) {
  for_each_free_trial([](const FreeTrial& trial) {
    const trial::TrialParameters& p = trial.parameters;
    const auto drive = literal_drive(p, trial.samples);
    const Real rate = 2 * std::numbers::pi_v<Real> * p.amplifier.bandwidth;
    const double count = 2.0 * std::numbers::pi / p.encoder.fine;
    boost::numeric::odeint::runge_kutta_fehlberg78<State, Real, State, Real> stepper;
    State state{0, p.initial.velocity};
    Real farthest = 0;
    for (std::size_t k = 0; k < trial.samples.size(); ++k) {
      farthest = std::max(farthest, std::abs(state[0]));
      ASSERT_NEAR(trial.samples[k].theta, static_cast<double>(state[0]),
                  1e-6 * count + 1e-12 * static_cast<double>(farthest))
          << "sample " << k;
      for (const LiteralDrive& part : drive[k]) {
        const auto slope = [&](const State& y, State& dydt, Real t) {
          const Real lag = rate == 0 ? 0 : (part.output - part.input) * std::exp(-rate * t);
          dydt = {y[1], (part.input + lag - p.plant.presliding_damping * y[1]) / p.plant.inertia};
        };
        const int steps = 1 + static_cast<int>(8 * rate * part.time);
        for (int i = 0; i < steps; ++i)
          stepper.do_step(slope, state, i * part.time / steps, part.time / steps);
      }
    }
  });
}

TEST(FreeTrial, HasNoContactState) {
  for_each_free_trial([](const FreeTrial& trial) {
    for (const trial::SampleRecord& sample : trial.samples) {
      ASSERT_EQ(sample.mode, trial::HookMode::slide);
      ASSERT_EQ(sample.xp, 0.0);
      ASSERT_EQ(sample.xh, 0.0);
      ASSERT_EQ(sample.depth, 0);
    }
    for (const trial::MoveOutcome& move : trial.outcome.moves) {
      EXPECT_FALSE(move.broke_away);
      EXPECT_EQ(move.creep, 0.0);
      EXPECT_EQ(move.reversal_depth, 0);
    }
  });
}

}  // namespace
}  // namespace zerocount::testing
