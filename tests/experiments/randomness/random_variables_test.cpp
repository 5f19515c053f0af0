#include "experiments/randomness/random_variables.hpp"

#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::randomness {
namespace {

using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;

constexpr const char* correlated = R"(zerocount: 1
name: variables
seed: 5
rigs: 50
trials: 100
correlation: [[friction.k1, friction.k2, 0.6]]
friction:
  k1: {lognormal: {median: 90, cv: 0.2}}
  k2: {uniform: [500, 1000]}
  beta: {profile: {mean: {log_uniform: [5.0e+4, 2.0e+5]}, cv: 0.1, correlation_length: 0.2}}
command: {targets: [{integers: [1, 30]}], hold: 0.1}
initial: {position: {uniform: [0, 6.283185307179586]}}
)";

study::Study a_study() {
  return manifest::parse_study(correlated, "test.yaml");
}

std::size_t place_of(const RandomVariables& variables, std::string_view name) {
  for (std::size_t i = 0; i < variables.variables.size(); ++i) {
    if (variables.variables[i].name == name) return i;
  }
  ADD_FAILURE() << "no variable " << name;
  return 0;
}

double value_in(const study::Study& study, const study::StudyTrial& trial, std::string_view name) {
  for (std::size_t i = 0; i < study.columns.inputs.size(); ++i) {
    if (study.columns.inputs[i].name == name) return trial.inputs[i];
  }
  ADD_FAILURE() << "no input " << name;
  return 0.0;
}

TEST(RandomVariables, HaveTheDistributionsUnitsAndCorrelationsOfTheManifest) {
  const RandomVariables found = random_variables(a_study(), 0);
  ASSERT_EQ(found.variables.size(), 6U);
  const std::size_t k1 = place_of(found, "friction.k1");
  const std::size_t k2 = place_of(found, "friction.k2");
  EXPECT_EQ(found.variables[k1].distribution, distributions::Distribution(distributions::Lognormal{90, 0.2}));
  EXPECT_EQ(found.variables[k1].unit, "N m/rad");
  EXPECT_EQ(found.variables[place_of(found, "friction.beta.mean")].distribution,
            distributions::Distribution(distributions::LogUniform{5e4, 2e5}));
  EXPECT_EQ(found.variables[place_of(found, "friction.beta")].unit, "1");  // its normal score
  EXPECT_DOUBLE_EQ(found.correlations[k1][k2], 0.6);
  EXPECT_DOUBLE_EQ(found.correlations[k2][k1], 0.6);
  EXPECT_EQ(found.correlations[k1][k1], 1.0);
  EXPECT_EQ(found.correlations[k1][place_of(found, "initial.position")], 0.0);
}

TEST(RandomVariables, ATrialWithTheirValuesHasThem) {
  const study::Study study = a_study();
  const RandomVariables found = random_variables(study, 0);
  std::mt19937_64 numbers(7);
  std::uniform_real_distribution<double> uniform(0.01, 0.99);
  for (std::int64_t number = 0; number < 50; ++number) {
    std::vector<double> x;
    for (const RandomVariable& variable : found.variables)
      x.push_back(distributions::quantile(variable.distribution, uniform(numbers)));
    const study::StudyTrial trial = study::study_trial(study, 0, 0, draws_with(study, found, x, number));
    std::vector<double> got, wanted;
    for (const char* const name : {"friction.k1", "friction.k2", "initial.position", "command.targets.0"}) {
      got.push_back(value_in(study, trial, name));
      wanted.push_back(x[place_of(found, name)]);
    }
    EXPECT_THAT(got, Pointwise(DoubleNear(1e-8), wanted));
  }
}

TEST(RandomVariables, AValueThatCannotBeDrawnIsRefusedByItsName) {
  const study::Study study = a_study();
  const RandomVariables found = random_variables(study, 0);
  std::vector<double> x;
  for (const RandomVariable& variable : found.variables) x.push_back(quantile(variable.distribution, 0.5));
  x[place_of(found, "friction.k2")] = 400.0;
  try {
    draws_with(study, found, x, 0);
    FAIL() << "400 is below the range";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("friction.k2 = 400"));
  }
}

}  // namespace
}  // namespace zerocount::randomness
