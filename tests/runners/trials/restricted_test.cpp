// A study under one condition, or at one age, has the machines and draws of the whole one.
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "runners/trials/variant.hpp"
#include "tests/support/test.hpp"

namespace zerocount::trials {
namespace {

constexpr const char* whole_life = R"(zerocount: 1
name: life
seed: 3
trials: 96
rigs: 4
design: {}
ages: {{at: [0, 1.0e+5, 1.0e+6], unit: cycles}}
conditions: {{warm: {{}}, "very. cold": {{plant.inertia: 8.0e-4, friction.k1: {{uniform: [120, 150]}}}}}}
command: {{targets: [{{integers: [1, 30]}}], hold: 0.2}}
friction:
  k1: {{lognormal: {{median: 110, cv: 0.2}}, aging: {{exponential: {{normal: {{mean: -0.3, sd: 0.1}}}}, scale: 1.0e+6}}}}
  lambda: {{value: 10, aging: {{logarithmic: -0.05, scale: 1.0e+4}}}}
initial: {{encoder_phase: {{uniform: [0, 1]}}}}
)";

void expect_same(const study::Study& one, const study::Study& whole) {
  const study::TrialTurns turns = study::turns_of(one);
  const study::TrialTurns all = study::turns_of(whole);
  EXPECT_EQ(study::draw_count(one), study::draw_count(whole));
  for (std::int64_t trial = 0; trial < one.trials; ++trial) {
    const std::string& name = one.conditions[static_cast<std::size_t>(turns.condition_of(trial))];
    const auto turn = std::ranges::find(whole.conditions, name) - whole.conditions.begin();
    ASSERT_LT(turn, std::ssize(whole.conditions)) << name;
    EXPECT_EQ(study::study_trial(one, 0, trial).inputs,
              study::study_trial(whole, 0, all.trial_of(turns.draw_of(trial), turn)).inputs)
        << name << ", trial " << trial;
  }
}

TEST(Restricted, HasTheMachinesAndDrawsOfTheWholeStudy) {
  for (const char* design : {"monte_carlo", "latin_hypercube", "sobol"}) {
    const study::Study whole =
        manifest::parse_study(fmt::format(fmt::runtime(whole_life), design), "life.yaml");
    for (const auto& condition : {std::optional<std::string>(), std::optional<std::string>("very. cold")}) {
      for (const auto& age : {std::optional<double>(), std::optional(1.0e5)}) {
        const study::Study one = restricted_to(whole, condition, age);
        EXPECT_EQ(one.condition_names.size(), condition ? 1U : 2U);
        EXPECT_EQ(one.ages.at.size(), age ? 1U : 3U);
        expect_same(one, whole);
      }
    }
  }
}

TEST(Restricted, RefusesWhatTheStudyDoesNotHave) {
  const study::Study whole =
      manifest::parse_study(fmt::format(fmt::runtime(whole_life), "monte_carlo"), "life.yaml");
  EXPECT_THROW(restricted_to(whole, "hot", {}), Failure);
  EXPECT_THROW(restricted_to(whole, {}, 7.0), Failure);
}

}  // namespace
}  // namespace zerocount::trials
