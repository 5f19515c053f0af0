#include "experiments/randomness/random_coordinates.hpp"

#include "core/friction/profile.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::randomness {
namespace {

constexpr const char* on_rigs = R"(zerocount: 1
name: rigs
seed: 5
rigs: 100
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

TEST(RandomCoordinates, AreWhatIsDrawnForRigsAndTrials) {
  const study::Study study = study_of(on_rigs);
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
  const study::Study study = study_of(on_rigs);
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
  const study::Study study = study_of(on_rigs);
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
  sections::Companions companions;
  companions.samples = [](const std::string&, std::string_view) {
    return std::string("friction.k1,friction.k2\n100,700\n110,710\n120,720\n130,730\n");
  };
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: rows\nseed: 5\ntrials: 100\nsamples: {file: p.csv, per: trial}\n"
      "friction: {alpha: {uniform: [0.1, 1.0]}}\ncommand: {targets: [10], hold: 0.1}\n",
      "test.yaml", {}, companions);
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
TEST(RandomCoordinates, TheNumberDecidesTheOtherRandomNumbers) {
  const study::Study study = study_of(on_rigs);
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

}  // namespace
}  // namespace zerocount::randomness
