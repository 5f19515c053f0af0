// Trials on an air bearing, with all that a loop can have: their motion by Boost.odeint under the torque that
// their drive should have, and what is told of a contact that is not there.
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "tests/core/trial/literal_rig.hpp"
#include "tests/core/trial/widened_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Real = long double;
using State = std::array<Real, 2>;  // θ (rad), ω (rad/s)

struct FreeTrial {
  trial::TrialParameters parameters;
  std::vector<trial::SampleRecord> samples;
  trial::TrialOutcome outcome;
};

/// A random trial, its friction taken away, and sometimes its damping.
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

TEST(FreeTrial, MovesAsItsEquationSays) {
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

TEST(FreeTrial, TellsOfNoContact) {
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
