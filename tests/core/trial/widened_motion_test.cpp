// The motion of the plant in random trials, by Boost.odeint under the torque that their drive should have.
#include <cstdint>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/trial/random_history.hpp"
#include "tests/core/trial/literal_rig.hpp"
#include "tests/core/trial/recorded_trials.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/odeint_motion.hpp"

namespace zerocount::testing {
namespace {

/// A motion beside the recorded one.
struct IntegratedMotion {
  std::vector<trial::SampleRecord> samples;  ///< the recorded ones with this motion
  std::vector<std::int64_t> breakaways;      ///< before each sample, and before the end of the trial
};

IntegratedMotion integrate(const RecordedTrial& trial) {
  const trial::TrialParameters& p = trial.parameters;
  const auto drive = literal_drive(p, trial.samples);
  const long double amplifier = 2 * std::numbers::pi_v<long double> * p.amplifier.bandwidth;
  OdeintMotion motion(p, trial::draw_history(p.initial.history, p.randomness));
  IntegratedMotion integrated{trial.samples, {}};
  for (std::size_t k = 0; k < trial.samples.size(); ++k) {
    trial::SampleRecord& sample = integrated.samples[k];
    sample.theta = static_cast<double>(motion.theta());
    sample.xp = static_cast<double>(motion.state()[2]);
    sample.xh = static_cast<double>(motion.state()[3]);
    sample.mode = motion.sliding() ? trial::HookMode::slide : trial::HookMode::stick;
    integrated.breakaways.push_back(motion.events().breakaways);
    for (const LiteralDrive& part : drive[k]) {
      if (part.time > 0) motion.advance({part.output, part.input, amplifier}, part.time);
    }
  }
  integrated.breakaways.push_back(motion.events().breakaways);
  return integrated;
}

TEST(WidenedMotion, IsThatOfThePlantUnderTheTorqueOfTheDrive) {
  Agreement total;
  std::size_t number = 0;
  for_each_trial([&](const RecordedTrial& trial) {
    if (number++ % 3 != 0) return;  // the other integrator is slow
    const IntegratedMotion integrated = integrate(trial);
    total.add(compare(trial.parameters, trial.samples, integrated.samples, trial.name));
    for_each_move(trial, [&](std::size_t move, const MoveSpan& span) {
      const bool slides = trial.samples[span.first].mode == trial::HookMode::slide;
      const bool breaks_away =
          integrated.breakaways[span.first + span.size] > integrated.breakaways[span.first];
      EXPECT_EQ(trial.outcome.moves[move].broke_away, slides || breaks_away);
    });
  });
  std::cout << total.figures() << "\n";
  for (const std::string& failure : total.failures) ADD_FAILURE() << failure;
  EXPECT_LT(total.before_breakaway, 1e-7);
  EXPECT_LT(total.after_breakaway_share, 0.1);
}

}  // namespace
}  // namespace zerocount::testing
