// why-presliding: an integral control holds zero counts on pre-sliding friction and on its spring alone; on
// Coulomb friction it never can (paper, section 1).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "experiments/study/study.hpp"
#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

class WithPresliding : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(WhyPresliding, WithPresliding, ::testing::Values("presliding", "spring"));

TEST_P(WithPresliding, TheLoopIsStableInAllTests) {
  const std::int64_t trials = 150;
  const auto outcomes = outcomes_of(shipped_study("why-presliding"), GetParam(), trials);
  EXPECT_TRUE(proportion_above(
      0.95,
      moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable && !move.broke_away; }),
      trials));
  EXPECT_TRUE(proportion_above(
      0.94,
      moves_with(outcomes,
                 [](const trial::MoveOutcome& move) { return move.outcome == trial::Outcome::zero_count; }),
      trials));
}

TEST(WhyPresliding, JerksComeFromCreepAndASpringAloneHasNone) {
  const study::Study study = shipped_study("why-presliding");
  const auto jerks = [](const trial::MoveOutcome& move) { return move.jerk_count > 0; };
  const std::int64_t trials = 100;
  EXPECT_TRUE(proportion_below(0.07, moves_with(outcomes_of(study, "spring", trials), jerks), trials));
  EXPECT_TRUE(proportion_above(0.3, moves_with(outcomes_of(study, "presliding", trials), jerks), trials));
}

/// One leap (stick-slip jump) of a plant with Coulomb friction, from the position where the contact stuck to
/// where it sticks again.
struct CoulombLeap {
  std::int64_t from{0};  ///< position error before the leap, counts
  std::int64_t to{0};    ///< position error after the leap, counts
  double torque{0.0};    ///< torque at breakaway, N m
  double peak{0.0};      ///< largest |torque| during the leap, N m
};

/// The leaps (stick-slip jumps) in the samples that begin after a rest of at least two samples, and end in
/// another rest.
std::vector<CoulombLeap> leaps_of(const std::vector<trial::SampleRecord>& samples) {
  std::vector<CoulombLeap> leaps;
  for (std::size_t k = 2; k < samples.size(); ++k) {
    const bool rested =
        samples[k - 2].mode == trial::HookMode::stick && samples[k - 1].mode == trial::HookMode::stick;
    if (!rested || samples[k].mode != trial::HookMode::slide) continue;
    CoulombLeap leap{samples[k - 1].error, 0, samples[k - 1].torque, 0.0};
    while (k < samples.size() && samples[k].mode == trial::HookMode::slide) {
      leap.peak = std::max(leap.peak, std::abs(samples[k].torque));
      ++k;
    }
    if (k == samples.size()) break;
    leap.to = samples[k].error;
    leaps.push_back(leap);
  }
  return leaps;
}

class WithCoulomb : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(WhyPresliding, WithCoulomb,
                         ::testing::Values("coulomb", "coulomb-without-static-level"));

TEST_P(WithCoulomb, TheLoopNeverArrives) {
  const study::Study study = shipped_study("why-presliding");
  const std::int64_t trials = 100;
  std::int64_t arrived = 0;
  for (std::int64_t index = 0; index < trials; ++index) {
    const trial::TrialParameters parameters = trial_of(study, GetParam(), index);
    const trial::MoveOutcome move = trial::run_trial(parameters).moves[0];
    arrived += move.arrived;
    EXPECT_GT(move.peak_torque, parameters.friction.uniform.breakaway);
  }
  EXPECT_TRUE(proportion_below(0.07, arrived, trials));
}

TEST_P(WithCoulomb, TheLoopHuntsForever) {
  // An error of one count winds the torque up from one breakaway to the other in 5 s. Then it goes faster.
  const study::Study study = shipped_study("why-presliding", {"command.hold=15"});
  for (std::int64_t index = 0; index < 12; ++index) {
    const WatchedTrial trial = watched(trial_of(study, GetParam(), index));
    std::int64_t crossings = 0;
    for (std::size_t k = trial.samples.size() - 10000; k < trial.samples.size(); ++k)
      crossings += trial.samples[k].error * trial.samples[k - 1].error < 0;
    EXPECT_GE(crossings, 10) << "in the last 5 s of trial " << index;
  }
}

// Not a matter of time, of the gain, or of luck with the encoder's dead band of one count. While the error
// has one sign, the torque grows from the breakaway torque, which is above all that friction can do: so the
// rotor gains speed up to the target's count, where the torque stays, and beyond. It cannot stop in that
// count, only on its other side.
TEST_P(WithCoulomb, NoStickSlipJumpEndsInTheTargetCount) {
  for (const auto& [ki, hold] : {std::pair{"3.85e-5", "2"}, {"1.0e-5", "8"}, {"1.0e-6", "30"}}) {
    const study::Study study = shipped_study(
        "why-presliding", {std::string("controller.ki=") + ki, std::string("command.hold=") + hold});
    std::int64_t leaps = 0;
    for (std::int64_t index = 0; index < 12; ++index) {
      const WatchedTrial trial = watched(trial_of(study, GetParam(), index));
      for (const CoulombLeap& leap : leaps_of(trial.samples)) {
        EXPECT_LT(leap.from * leap.to, 0) << "it ends beyond the target";
        EXPECT_GT(std::abs(leap.torque), trial.parameters.friction.uniform.breakaway);
        ++leaps;
      }
      for (const trial::SampleRecord& sample : trial.samples)
        ASSERT_FALSE(sample.error == 0 && sample.mode == trial::HookMode::stick) << "at rest at zero error";
    }
    EXPECT_GE(leaps, 8) << ki;
  }
}

/// Ratio of the error after a leap to the error before it, without a static level and damping. With
/// J·y‴ = −K·y, y(0) = −1, y′(0) = y″(0) = 0, the solution is y = −⅓[exp(−τ) + 2·exp(τ/2)·cos(√3·τ/2)],
/// τ = (K/J)^⅓·t, which ends at the first zero of y′ ∝ exp(−3τ/2) − 2·cos(√3·τ/2 + π/3).
double growth_of_a_leap() {
  double low = 3.0, high = 5.0;
  const auto derivative = [](double tau) {
    return std::exp(-1.5 * tau) - 2.0 * std::cos(0.5 * std::numbers::sqrt3 * tau + std::numbers::pi / 3.0);
  };
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (derivative(middle) * derivative(low) > 0.0 ? low : high) = middle;
  }
  return -(std::exp(-low) + 2.0 * std::exp(0.5 * low) * std::cos(0.5 * std::numbers::sqrt3 * low)) / 3.0;
}

TEST(WhyPresliding, EveryStickSlipJumpIsLargerThanTheLast) {
  const double growth = growth_of_a_leap();
  EXPECT_NEAR(growth, 4.78, 0.01);
  // The slower, the closer to the closed form: sampling delays the torque by what is a part of a leap.
  for (const auto& [ki, hold, excess] :
       {std::tuple{"3.85e-5", "2", 1.2}, {"1.0e-5", "8", 1.12}, {"1.0e-6", "40", 1.06}}) {
    const study::Study study = shipped_study(
        "why-presliding", {std::string("controller.ki=") + ki, std::string("command.hold=") + hold});
    std::int64_t compared = 0;
    for (std::int64_t index = 0; index < 12; ++index) {
      const WatchedTrial trial = watched(trial_of(study, "coulomb-without-static-level", index));
      const double highest = 2047 * trial.parameters.dac.resolution;
      for (const CoulombLeap& leap : leaps_of(trial.samples)) {
        const double from = std::abs(static_cast<double>(leap.from));
        const double to = std::abs(static_cast<double>(leap.to));
        if (leap.peak >= highest) continue;  // clipped: the amplitude at which it goes on for ever
        EXPECT_GE(to, from);
        if (from < 20.0) continue;  // the counts are too coarse to tell by how much
        EXPECT_GT(to + 1.0, growth * (from - 1.0)) << ki;
        EXPECT_LT(to - 1.0, growth * excess * (from + 1.0)) << ki;
        ++compared;
      }
    }
    EXPECT_GE(compared, 15) << ki;
  }
}

}  // namespace
}  // namespace zerocount::testing
