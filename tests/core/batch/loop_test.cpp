// The control loop in the lanes: delay, gains, anti-windup, and converters of any word.
#include "tests/core/batch/expect_agreement.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

TEST(BatchLoop, DelaysTheTorque) {
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

TEST(BatchLoop, HasProportionalAndDifferentialParts) {
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

/// Words so short that torques are clipped, and so fine that no code is the same for long.
TEST(BatchLoop, ConvertsByAnyWord) {
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

}  // namespace
}  // namespace zerocount::testing
