#include "experiments/randomness/random_coordinates.hpp"

#include "core/friction/profile.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/randomness/random_variables.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/test.hpp"

namespace zerocount::randomness {
namespace {

constexpr const char* on_machines = R"(zerocount: 1
name: machines
seed: 5
machines: 100
trials: 200
friction:
  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.1}}, cv: 0.1, correlation_length: 0.2}}
  k2: {uniform: [500, 1000]}
  alpha: {uniform: [0.1, 1.0], per: contact}
command: {targets: [{integers: [1, 30]}], hold: 0.1}
initial: {position: {uniform: [0, 6.283185307179586]}, encoder_phase: 0.5}
)";

study::Study study_of(const std::string& text) {
  return manifest::parse_study(text, "test.yaml");
}

std::vector<double> normals(std::mt19937_64& numbers, std::size_t count) {
  std::normal_distribution<double> normal;
  std::vector<double> z;
  for (std::size_t i = 0; i < count; ++i) z.push_back(normal(numbers));
  return z;
}

double input_of(const study::Study& study, const study::StudyTrial& trial, std::string_view name) {
  for (std::size_t i = 0; i < study.columns.inputs.size(); ++i) {
    if (study.columns.inputs[i].name == name) return trial.inputs[i];
  }
  ADD_FAILURE() << "no input " << name;
  return 0.0;
}

TEST(RandomCoordinates, AreTheParametersDrawnForMachinesAndTrials) {
  const study::Study study = study_of(on_machines);
  std::vector<std::string> names;
  std::vector<std::string> of_machine;
  for (const RandomCoordinate& one : random_coordinates(study, 0)) {
    names.push_back(one.name);
    if (one.of_machine) of_machine.push_back(one.name);
  }
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"command.targets.0", "friction.alpha", "friction.k1",
                                             "friction.k1.mean", "friction.k2", "initial.position"}));
  std::ranges::sort(of_machine);
  EXPECT_EQ(of_machine, (std::vector<std::string>{"friction.k1", "friction.k1.mean", "friction.k2"}));
}

TEST(RandomCoordinates, DecideTheQuantiles) {
  const study::Study study = study_of(on_machines);
  const std::vector<RandomCoordinate> coordinates = random_coordinates(study, 0);
  std::mt19937_64 numbers(3);
  for (std::int64_t number = 0; number < 20; ++number) {
    const std::vector<double> z = normals(numbers, coordinates.size());
    const study::StudyTrial trial = study::study_trial(study, 0, 0, draws_at(study, coordinates, z, number));
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const double u = numerics::normal_probability(z[i]);
      const std::string& name = coordinates[i].name;
      if (name == "friction.k2") {
        EXPECT_NEAR(input_of(study, trial, name), 500.0 + 500.0 * u, 1e-9);
      }
      if (name == "command.targets.0") {
        EXPECT_EQ(trial.parameters.command.targets[0], static_cast<std::int64_t>(std::floor(30.0 * u)) + 1);
      }
      if (name != "friction.k1") continue;
      const auto& profile = *trial.parameters.friction.profiled.at(0).profile;
      EXPECT_NEAR(friction::field_at(profile, trial.parameters.initial.position), z[i], 1e-9);
    }
  }
}

// Whatever the field at the start is, far from it the field keeps its distribution.
TEST(RandomCoordinates, AProfileStaysARandomField) {
  const study::Study study = study_of(on_machines);
  const std::vector<RandomCoordinate> coordinates = random_coordinates(study, 0);
  std::mt19937_64 numbers(4);
  constexpr int trials = 4000;
  double near = 0.0;
  double far_squares = 0.0;
  double far_products = 0.0;
  for (int number = 0; number < trials; ++number) {
    const std::vector<double> z = normals(numbers, coordinates.size());
    const study::StudyTrial trial = study::study_trial(study, 0, 0, draws_at(study, coordinates, z, number));
    const auto& profile = *trial.parameters.friction.profiled.at(0).profile;
    const double start = trial.parameters.initial.position;
    const double here = friction::field_at(profile, start);
    const double far = friction::field_at(profile, start + 2.0);
    near += here * friction::field_at(profile, start + 0.2) / trials;
    far_squares += far * far / trials;
    far_products += here * far / trials;
  }
  EXPECT_NEAR(near, std::exp(-1.0), 0.07);  // the correlation at the correlation length
  EXPECT_NEAR(far_squares, 1.0, 0.1);
  EXPECT_NEAR(far_products, 0.0, 0.07);
}

TEST(RandomCoordinates, CorrelatedValuesKeepTheirCorrelation) {
  const study::Study study = study_of(R"(zerocount: 1
name: correlated
seed: 5
trials: 100
friction: {k1: {lognormal: {median: 110, cv: 0.2}}, k2: {lognormal: {median: 700, cv: 0.2}}, beta: {lognormal: {median: 1.0e+5, cv: 0.2}}}
correlation: [[friction.k1, friction.beta, 0.8]]
command: {targets: [10], hold: 0.1}
)");
  const std::vector<RandomCoordinate> coordinates = random_coordinates(study, 0);
  std::mt19937_64 numbers(6);
  constexpr int trials = 4000;
  double correlation = 0.0;
  double independent = 0.0;
  for (int number = 0; number < trials; ++number) {
    const study::StudyTrial trial = study::study_trial(
        study, 0, 0, draws_at(study, coordinates, normals(numbers, coordinates.size()), number));
    const auto score = [&](std::string_view name, double median) {
      return std::log(input_of(study, trial, name) / median) / std::sqrt(std::log(1.04));
    };
    const double k1 = score("friction.k1", 110.0);
    correlation += k1 * score("friction.beta", 1e5) / trials;
    independent += k1 * score("friction.k2", 700.0) / trials;
  }
  EXPECT_NEAR(correlation, 0.8, 0.06);
  EXPECT_NEAR(independent, 0.0, 0.06);
}

// Joint draws are one coordinate, which chooses the row.
TEST(RandomCoordinates, RowsOfJointDrawsAreOneCoordinate) {
  sections::ExternalInputs external;
  external.samples = [](const std::string&, std::string_view) {
    return std::string("friction.k1,friction.k2\n100,700\n110,710\n120,720\n130,730\n");
  };
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: rows\nseed: 5\ntrials: 100\nsamples: {file: p.csv, per: trial}\n"
      "friction: {alpha: {uniform: [0.1, 1.0]}}\ncommand: {targets: [10], hold: 0.1}\n",
      "test.yaml", {}, external);
  const std::vector<RandomCoordinate> coordinates = random_coordinates(study, 0);
  ASSERT_EQ(coordinates.size(), 2U);
  const std::size_t rows = coordinates[0].rows > 0 ? 0 : 1;
  EXPECT_EQ(coordinates[rows].rows, 4);
  EXPECT_EQ(coordinates[1 - rows].rows, 0);
  for (int row = 0; row < 4; ++row) {
    std::vector<double> z{0.3, 0.3};
    z[rows] = numerics::normal_quantile((row + 0.5) / 4.0);
    const study::StudyTrial trial = study::study_trial(study, 0, 0, draws_at(study, coordinates, z, 1));
    EXPECT_EQ(input_of(study, trial, "friction.k1"), 100.0 + 10.0 * row);
    EXPECT_EQ(input_of(study, trial, "friction.k2"), 700.0 + 10.0 * row);
  }
}

// The number of a trial decides what the coordinates do not: noise, later contacts, the rest of the rotor.
TEST(RandomCoordinates, TheTrialNumberDecidesTheOtherRandomNumbers) {
  const study::Study study = study_of(on_machines);
  const std::vector<RandomCoordinate> coordinates = random_coordinates(study, 0);
  const std::vector<double> z(coordinates.size(), 0.3);
  const study::StudyTrial one = study::study_trial(study, 0, 0, draws_at(study, coordinates, z, 7));
  const study::StudyTrial same = study::study_trial(study, 0, 0, draws_at(study, coordinates, z, 7));
  const study::StudyTrial other =
      study::study_trial(study, 0, 0, draws_at(study, coordinates, z, 1'000'000'007));
  EXPECT_EQ(one.parameters.randomness.trial, 7U);
  EXPECT_EQ(other.parameters.randomness.trial, 1'000'000'007U);
  const auto cosine = [](const study::StudyTrial& trial) {
    return trial.parameters.friction.profiled.at(0).profile->cosine;
  };
  EXPECT_EQ(cosine(one), cosine(same));
  EXPECT_NE(cosine(one), cosine(other));
}

using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;

constexpr const char* correlated = R"(zerocount: 1
name: variables
seed: 5
machines: 50
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

TEST(RandomVariables, ATrialAtGivenValuesHasThem) {
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
  EXPECT_TRUE(says(refusal_by([&] { draws_with(study, found, x, 0); }), "friction.k2 = 400"));
}

// A discrete draw is known value by value: which one is drawn at given coordinates, and coordinates that draw
// a given one.

/// Three discrete draws, of which two are correlated with each other and with a continuous one.
constexpr const char* with_discrete_draws = R"(zerocount: 1
name: discrete
seed: 5
trials: 10
friction:
  k1: {choice: [110, 90, 130, 110, 110]}
  k2: {uniform: [500, 1000]}
  beta: {choice: [1.0e+5, 1.2e+5, 1.5e+5]}
correlation: [[friction.k2, friction.k1, 0.6], [friction.k1, friction.beta, -0.4]]
command: {targets: [{integers: [-3, 30]}], hold: 0.1}
)";

std::vector<double> normals_of(std::mt19937_64& numbers, std::size_t count) {
  std::normal_distribution<double> normal;
  std::vector<double> z;
  for (std::size_t i = 0; i < count; ++i) z.push_back(normal(numbers));
  return z;
}

double input_named(const study::Study& study, const study::StudyTrial& trial, std::string_view name) {
  for (std::size_t i = 0; i < study.columns.inputs.size(); ++i) {
    if (study.columns.inputs[i].name == name) return trial.inputs[i];
  }
  ADD_FAILURE() << "no input " << name;
  return 0.0;
}

class DiscreteDraws : public ::testing::Test {
 protected:
  std::string value_in_trial(const DiscreteDraw& draw, const std::vector<double>& z) const {
    const study::StudyTrial trial = study::study_trial(study_, 0, 0, draws_at(study_, coordinates_, z, 1));
    return fmt::format("{:.6g}", input_named(study_, trial, draw.name));
  }

  study::Study study_ = manifest::parse_study(with_discrete_draws, "test.yaml");
  std::vector<RandomCoordinate> coordinates_ = random_coordinates(study_, 0);
  std::vector<DiscreteDraw> draws_ = discrete_draws(study_, 0, coordinates_);
};

TEST_F(DiscreteDraws, AreTheChoicesAndIntegers) {
  ASSERT_EQ(draws_.size(), 3U);
  for (const DiscreteDraw& draw : draws_) {
    double squares = 0.0;
    for (const auto& [coordinate, factor] : draw.direction) squares += factor * factor;
    EXPECT_NEAR(squares, 1.0, 1e-12) << draw.name;
    EXPECT_EQ(draw.rows, draw.name == "friction.k1" ? 5 : draw.values());  // equal entries are one value
    EXPECT_EQ(draw.ordered, draw.name != "friction.k1");
    EXPECT_EQ(draw.values(), draw.name == "command.targets.0" ? 34 : 3);
  }
}

TEST_F(DiscreteDraws, GiveTheValueOfTheTrial) {
  std::mt19937_64 numbers(3);
  for (int i = 0; i < 300; ++i) {
    const std::vector<double> z = normals_of(numbers, coordinates_.size());
    for (const DiscreteDraw& draw : draws_)
      EXPECT_EQ(value_in_trial(draw, z), value_text(draw, value_at(draw, z))) << draw.name;
  }
}

// Points moved to the rows in turn are as those that are drawn: every coordinate keeps its distribution.
TEST_F(DiscreteDraws, CanBeSetToAnyRow) {
  std::mt19937_64 numbers(4);
  std::uniform_real_distribution<double> uniform(1e-9, 1.0 - 1e-9);
  for (const DiscreteDraw& draw : draws_) {
    std::vector<double> sum(coordinates_.size()), squares(coordinates_.size());
    double products = 0.0;
    constexpr int count = 6800;  // a multiple of the rows of each draw
    for (int i = 0; i < count; ++i) {
      std::vector<double> z = normals_of(numbers, coordinates_.size());
      const std::int64_t row = i % draw.rows;
      move_to_row(draw, row, uniform(numbers), z);
      EXPECT_EQ(value_at(draw, z), value_of_row(draw, row));
      for (std::size_t k = 0; k < z.size(); ++k) {
        sum[k] += z[k];
        squares[k] += z[k] * z[k];
      }
      products += z[0] * z[1];
    }
    for (std::size_t k = 0; k < sum.size(); ++k) {
      EXPECT_NEAR(sum[k] / count, 0.0, 0.06);
      EXPECT_NEAR(squares[k] / count, 1.0, 0.08);
    }
    EXPECT_NEAR(products / count, 0.0, 0.06);
  }
}

TEST(DiscreteDrawsOfSamples, ARowOfSamplesIsOneDraw) {
  const DiscreteDraw draw{.name = "samples", .direction = {{0, 1.0}}, .rows = 20};
  EXPECT_EQ(draw.values(), 20);
  EXPECT_EQ(value_text(draw, 17), "row 17");
}

}  // namespace
}  // namespace zerocount::randomness
