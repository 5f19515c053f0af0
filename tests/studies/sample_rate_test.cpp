// sample-rate: a slow loop costs the proportional gain its stability, and the integral alone next to nothing.
#include <string>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t rate_trials = 200;

std::int64_t stable_at_rate(const std::string& label) {
  return moves_with(outcomes_of(shipped_study("sample-rate"), label, rate_trials),
                    [](const trial::MoveOutcome& move) { return move.stable; });
}

TEST(SampleRate, TheIntegralAloneIsStableAtTwoAndAHalfTimesTheNaturalFrequency) {
  EXPECT_TRUE(share_above(0.96, stable_at_rate("integral, controller.sample_rate=500"), rate_trials));
}

TEST(SampleRate, TheProportionalGainNeedsTenTimesTheNaturalFrequency) {
  EXPECT_TRUE(share_below(0.65, stable_at_rate("with-kp, controller.sample_rate=500"), rate_trials));
  EXPECT_TRUE(share_below(0.90, stable_at_rate("with-kp, controller.sample_rate=1000"), rate_trials));
  EXPECT_TRUE(share_above(0.93, stable_at_rate("with-kp, controller.sample_rate=2000"), rate_trials))
      << "the paper's rate";
  EXPECT_TRUE(share_above(0.96, stable_at_rate("with-kp, controller.sample_rate=4000"), rate_trials));
}

// ki·Δx·T/2 and kp·Δx: the loops of all rates are one controller.
TEST(SampleRate, TheGainsAreThoseOfOneController) {
  const study::Study study = shipped_study("sample-rate");
  for (const auto& [rate, factor] : {std::pair{"500", 4.0}, {"2000", 1.0}, {"20000", 0.1}}) {
    const trial::TrialParameters p =
        trial_of(study, std::string("with-kp, controller.sample_rate=") + rate, 0);
    EXPECT_NEAR(p.controller.ki / (9.45e-5 * factor), 1.0, 2e-3);
    EXPECT_NEAR(p.controller.kp / 6.21e-4, 1.0, 2e-3);
  }
}

}  // namespace
}  // namespace zerocount::testing
