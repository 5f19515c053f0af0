// The age at which tuned values lose a goal, of machines whose rate at each age has a closed form.
#include "runners/tuning/ages/lost_ages.hpp"

#include "core/numerics/roots.hpp"
#include "experiments/manifest/load_study.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using tuning::LostAges;

constexpr const char* life_text = R"(zerocount: 1
name: life
seed: 5
trials: 600
machines: 200
ages: {at: [0, 1.0e+5, 1.0e+6], unit: cycles}
command: {targets: [29], hold: 0.3}
friction:
  k1: {uniform: [50, 250], aging: {exponential: 0.4, scale: 1.0e+6}}
controller: {ki: 3.0e-5, delay: 1}
goal: {band: 1, within: 0.06, moves: 0.8}
tune: {free: {controller.ki: [1.0e-5, 1.0e-4]}}
)";

constexpr double rate_of_k1 = 0.4;

study::Study life_study(const std::vector<std::string>& overrides = {}) {
  return manifest::parse_study(life_text, "life.yaml", overrides);
}

LostAges lost_of(const std::vector<std::string>& overrides = {}) {
  const study::Study study = life_study(overrides);
  return tuning::lost_ages(study,
                           {study.machines, std::max<std::int64_t>(study.settings.conditions.size(), 1)}, {});
}

/// The largest k1 with which a move meets the goal.
double largest_k1() {
  const auto meets = [](double k1) {
    const study::Study one =
        life_study({fmt::format("friction.k1={{value: {}, aging: {{linear: 0, scale: 1}}}}", k1)});
    return tuning::results_of(one, {1, 3}, 1, nullptr, {}).front().claims.front().met == 1;
  };
  EXPECT_TRUE(meets(100.0));
  EXPECT_FALSE(meets(1000.0));
  return numerics::bisect({100.0, 1000.0}, meets, numerics::within(0.01)).holds;
}

/// The true age at which k1 exceeds `limit` in 20 % of the machines, so that 80 % still meet the goal.
double true_age(double limit) {
  return 1.0e6 / rate_of_k1 * std::log(limit / (50.0 + 0.8 * 200.0));
}

TEST(AgeOfLoss, IsTheAgeAtWhichTooManyMachinesLeaveTheLimit) {
  const double truth = true_age(largest_k1());
  const LostAges found = lost_of({"machines=4000", "trials=12000"});
  ASSERT_EQ(found.claims.size(), 1U);
  ASSERT_TRUE(found.claims[0].lost);
  EXPECT_NEAR(*found.claims[0].lost / truth, 1.0, 0.15);
  EXPECT_LE(*found.claims[0].met_until, truth);
  EXPECT_GE(*found.claims[0].missed_from, truth);
  EXPECT_LT(*found.claims[0].missed_from / *found.claims[0].met_until, 1.5);
  EXPECT_TRUE(std::ranges::is_sorted(found.tried, {}, &tuning::AgeVerdict::age));
}

TEST(AgeOfLoss, BoundsCoverTheAgeWithTheConfidenceOfTheGoal) {
  const double truth = true_age(largest_k1());
  constexpr int populations = 40;
  int too_late = 0;
  int too_early = 0;
  for (int seed = 0; seed < populations; ++seed) {
    const LostAges found = lost_of({fmt::format("seed={}", seed), "machines=50", "trials=150"});
    too_late += found.claims[0].met_until > truth ? 1 : 0;
    too_early += found.claims[0].missed_from < truth ? 1 : 0;
  }
  // 5 % each: more than 6 of 40 have a probability of 0.3 %.
  EXPECT_LE(too_late, 6);
  EXPECT_LE(too_early, 6);
}

TEST(AgeOfLoss, IsGivenForEachClaim) {
  const LostAges found = lost_of({"goal={band: 1, within: 0.1, moves: 0.8}", "trials=1200",
                                  "conditions={light: {}, stiff: {friction.k1: {uniform: [75, 375]}}}"});
  ASSERT_EQ(found.claims.size(), 2U);
  EXPECT_EQ(found.claims[1].claim.setting, 1U);
  // The stiff ones are where the light ones are after the time in which k1 grows by a half.
  EXPECT_NEAR(*found.claims[0].lost - *found.claims[1].lost, 1.0e6 / rate_of_k1 * std::log(1.5),
              0.2 * *found.claims[0].lost);
}

TEST(AgeOfLoss, IsAbsentIfNoMachineIsLost) {
  const LostAges found =
      lost_of({"friction.k1={uniform: [50, 250], aging: {logarithmic: 0.001, scale: 1.0e+6}}"});
  EXPECT_FALSE(found.claims[0].lost);
  EXPECT_FALSE(found.claims[0].missed_from);
  EXPECT_EQ(found.claims[0].met_until, 1.0e12);
  EXPECT_EQ(found.tried.back().age, 1.0e12);
}

TEST(AgeOfLoss, EndsWhereAValueWouldLeaveItsRange) {
  const LostAges found = lost_of({"friction.k1={uniform: [50, 250], aging: {linear: -0.1, scale: 1.0e+6}}"});
  EXPECT_TRUE(says(found.refusal, "friction.k1"));
  EXPECT_LT(found.tried.back().age, 1.0e7);
  EXPECT_GT(found.tried.back().age, 0.97e7);
}

TEST(AgeOfLoss, AGoalMissedFromTheStartIsReported) {
  const LostAges found = lost_of({"goal={band: 1, within: 0.01, moves: 0.8}"});
  EXPECT_EQ(found.claims[0].lost, 0.0);
  EXPECT_FALSE(found.claims[0].met_until);
  EXPECT_EQ(found.claims[0].missed_from, 0.0);
}

}  // namespace
}  // namespace zerocount::testing
