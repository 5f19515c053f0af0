// Correlated parameters: the correlation of their normal scores is the stated one, and each keeps its
// distribution, whatever the design and however often they are drawn.
#include <Eigen/LU>
#include <boost/math/distributions/normal.hpp>

#include "core/trial/trial_of.hpp"
#include "experiments/study/draws.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/core/friction/spring_damper.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

const std::string three_uniform =
    "friction: {k1: {uniform: [100, 101]}, k2: {uniform: [700, 701]}, beta: {uniform: [100000, 100001]}}\n";
const std::string two_pairs =
    "correlation: [[friction.k2, friction.k1, 0.6], [friction.k1, friction.beta, -0.5]]\n";

/// [parameter][trial or machine] the uniform numbers that the study draws for its three parameters.
std::vector<std::vector<double>> uniforms(const Study& study, std::int64_t count) {
  std::vector<std::vector<double>> numbers(3);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::vector<double> inputs = study_trial(study, 0, i).inputs;
    numbers[0].push_back(inputs[column_of(study, "friction.k1")] - 100.0);
    numbers[1].push_back(inputs[column_of(study, "friction.k2")] - 700.0);
    numbers[2].push_back(inputs[column_of(study, "friction.beta")] - 1e5);
  }
  return numbers;
}

double correlation_of_scores(const std::vector<double>& a, const std::vector<double>& b) {
  const boost::math::normal standard;
  double sum = 0.0;
  double squares_a = 0.0;
  double squares_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = boost::math::quantile(standard, a[i]);
    const double y = boost::math::quantile(standard, b[i]);
    sum += x * y;
    squares_a += x * x;
    squares_b += y * y;
  }
  return sum / std::sqrt(squares_a * squares_b);
}

/// Largest difference of the empirical distribution function of the values from the uniform one (the
/// Kolmogorov–Smirnov statistic).
double distance_from_uniform(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double distance = 0.0;
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    distance = std::max(
        {distance, static_cast<double>(i + 1) / n - values[i], values[i] - static_cast<double>(i) / n});
  }
  return distance;
}

TEST(Copula, HasTheStatedCorrelationsAndKeepsTheDistributions) {
  constexpr std::int64_t count = 8000;
  const double four_errors = 4.0 / std::sqrt(double(count));
  for (const std::string design : {"monte_carlo", "latin_hypercube", "sobol"}) {
    const Study study = study_of(minimal_manifest(three_uniform + two_pairs),
                                 {"design=" + design, fmt::format("trials={}", count)});
    const std::vector<std::vector<double>> u = uniforms(study, count);
    EXPECT_NEAR(correlation_of_scores(u[0], u[1]), 0.6, four_errors) << design;
    EXPECT_NEAR(correlation_of_scores(u[0], u[2]), -0.5, four_errors) << design;
    EXPECT_NEAR(correlation_of_scores(u[1], u[2]), 0.0, four_errors) << design;
    for (const std::vector<double>& values : u)
      EXPECT_LT(distance_from_uniform(values), 1.9 / std::sqrt(double(count))) << design;  // p = 0.001
  }
}

TEST(Copula, CorrelatesMachinesIfTheParametersAreDrawnPerMachine) {
  constexpr std::int64_t machines = 4000;
  const Study study = study_of(minimal_manifest(three_uniform + two_pairs), {"machines=4000", "trials=8000"});
  const std::vector<std::vector<double>> u = uniforms(study, machines);
  EXPECT_NEAR(correlation_of_scores(u[0], u[1]), 0.6, 4.0 / std::sqrt(double(machines)));
  for (const std::int64_t machine : {0, 17, 3999}) {
    const StudyTrial first = study_trial(study, 0, machine);
    EXPECT_EQ(first.inputs, study_trial(study, 0, machine + machines).inputs);
    EXPECT_EQ(first.inputs, group_inputs(study, Grouping::machine, machine));
  }
}

TEST(Copula, DoesNotChangeTheFirstAndTheUncorrelatedParameters) {
  const std::string with_lambda = three_uniform + "initial: {position: {uniform: [0, 6]}}\n";
  const Study plain = study_of(minimal_manifest(with_lambda));
  const Study correlated = study_of(minimal_manifest(with_lambda + two_pairs));
  for (const char* name : {"friction.k1", "initial.position"}) {
    const std::size_t column = column_of(plain, name);
    for (std::int64_t i = 0; i < 5; ++i)
      EXPECT_EQ(study_trial(plain, 0, i).inputs[column], study_trial(correlated, 0, i).inputs[column]);
  }
  EXPECT_NE(study_trial(plain, 0, 1).inputs, study_trial(correlated, 0, 1).inputs);
}

TEST(Copula, DoesNotDependOnTheOrderOfItsEntries) {
  const Study one = study_of(minimal_manifest(three_uniform + two_pairs));
  const Study other = study_of(minimal_manifest(
      three_uniform +
      "correlation: [[friction.beta, friction.k1, -0.5], [friction.k1, friction.k2, 0.6]]\n"));
  for (std::int64_t i = 0; i < 5; ++i)
    EXPECT_EQ(study_trial(one, 0, i).inputs, study_trial(other, 0, i).inputs);
}

TEST(Copula, CholeskyFactorExistsOnlyForPositiveDefiniteMatrices) {
  std::mt19937_64 numbers(2026);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int definite = 0;
  for (int repetition = 0; repetition < 300; ++repetition) {
    Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
    r(0, 1) = r(1, 0) = uniform(numbers);
    r(0, 2) = r(2, 0) = uniform(numbers);
    r(1, 2) = r(2, 1) = uniform(numbers);
    const auto rows =
        cholesky_factor({{1.0, r(0, 1), r(0, 2)}, {r(1, 0), 1.0, r(1, 2)}, {r(2, 0), r(2, 1), 1.0}});
    ASSERT_EQ(rows.has_value(), r.determinant() > 0.0) << r;  // |ρ| < 1 makes the smaller minors positive
    if (!rows) continue;
    Eigen::Matrix3d factor;
    for (int i = 0; i < 3; ++i)
      factor.row(i) = Eigen::RowVector3d::Map((*rows)[static_cast<std::size_t>(i)].data());
    ++definite;
    EXPECT_LT((factor * factor.transpose() - r).norm(), 1e-14);
  }
  EXPECT_GT(definite, 100);
}

// A whole trial in closed loop with a friction law that only the tests know, from the text of a manifest.

/// The laws of the program, with that of the tests as the one which manifests call presliding.
using LawsOfTheTests = friction::LawList<SpringDamper, friction::SpringFriction, friction::CoulombFriction,
                                         friction::NoFriction>;

trial::TrialParameters first_trial(const std::string& more) {
  const Study study = study_of(manifest_commanding("{targets: [20], hold: 0.5}", more));
  return study_trial(study, 0, 0).parameters;
}

trial::TrialOutcome run(const trial::TrialParameters& parameters, std::vector<trial::SampleRecord>& records) {
  return trial::run_trial_of<plant::PlantOf<LawsOfTheTests>>(
      parameters,
      {.sample = [&](const trial::SampleRecord& record) { records.push_back(record); }, .jerk = {}});
}

TEST(AddedFrictionLaw, RunsATrialInClosedLoopFromAManifest) {
  const trial::TrialParameters p =
      first_trial("controller: {ki: 2.0e-5}\nfriction: {k1: 200}\ndac: {bits: 16}\n");
  std::vector<trial::SampleRecord> records;
  const trial::TrialOutcome outcome = run(p, records);
  const trial::MoveOutcome& move = outcome.moves.at(0);
  EXPECT_EQ(records.size(), 1000U);
  EXPECT_EQ(move.outcome, trial::Outcome::zero_count);
  EXPECT_FALSE(move.broke_away);
  // At rest the torque that is held is that of the spring.
  EXPECT_NEAR(move.final_position, move.holding_torque / 200.0, 1e-9);
  // The error dies out with the time constant of the linear loop.
  const double tau = theory::slowest_time_constant(200.0, p.plant, p.encoder, p.controller);
  EXPECT_GT(move.arrival_time, 1.5 * tau);
  EXPECT_LT(move.arrival_time, 6.0 * tau);
}

TEST(AddedFrictionLaw, IsUnstableBeyondTheBoundOfItsStiffness) {
  for (const double factor : {0.5, 1.5}) {
    trial::TrialParameters p = first_trial("friction: {k1: 200}\n");
    p.controller.ki =
        factor * theory::sampled_critical_integral_gain(200.0, p.plant, p.encoder, p.controller);
    std::vector<trial::SampleRecord> records;
    EXPECT_EQ(run(p, records).moves.at(0).stable, factor < 1.0);
  }
}

TEST(AddedFrictionLaw, DoesNotChangeOtherLaws) {
  for (const std::string model : {"spring", "coulomb", "none"}) {
    const trial::TrialParameters p = first_trial("friction: {model: " + model + "}\n");
    std::vector<trial::SampleRecord> records;
    EXPECT_EQ(run(p, records).moves.at(0).final_position, trial::run_trial(p).moves.at(0).final_position)
        << model;
  }
}

// The lowest value that a parameter is designed for, against closed forms.

class LowEndOfRandomDistributions : public ::testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// The low end of friction.k1 in a study that gives it this value.
  static LowEnd low_end_of(const std::string& k1) {
    return low_end(study_of(minimal_manifest("friction: {k1: " + k1 + "}\n")), 0, "friction.k1");
  }
  static void expect(LowEnd found, LowEnd::Kind kind, double value) {
    EXPECT_EQ(found.kind, kind);
    EXPECT_NEAR(found.value, value, 1e-11 * value);
  }

  static constexpr int rounds = 100;

 private:
  std::mt19937_64 random_{71};
};

const boost::math::normal_distribution<double> standard_normal;
const double normal_tail = boost::math::quantile(standard_normal, 0.001);  // −3.09

TEST_F(LowEndOfRandomDistributions, ANumberIsItsOwnLowEnd) {
  for (int round = 0; round < rounds; ++round) {
    const double k1 = uniform(1.0, 1000.0);
    expect(low_end_of(fmt::format("{}", k1)), LowEnd::Kind::number, k1);
  }
}

TEST_F(LowEndOfRandomDistributions, ABoundedDistributionEndsAtItsSupport) {
  for (int round = 0; round < rounds; ++round) {
    const double low = uniform(1.0, 500.0), middle = low + uniform(0.0, 100.0);
    const double high = middle + uniform(1.0, 100.0);
    for (const std::string& k1 : {fmt::format("{{uniform: [{}, {}]}}", low, high),
                                  fmt::format("{{log_uniform: [{}, {}]}}", low, high),
                                  fmt::format("{{triangular: [{}, {}, {}]}}", low, middle, high),
                                  fmt::format("{{choice: [{}, {}, {}]}}", middle, low, high)}) {
      expect(low_end_of(k1), LowEnd::Kind::support, low);
    }
    const auto whole = static_cast<std::int64_t>(low);
    expect(low_end_of(fmt::format("{{integers: [{}, {}]}}", whole, whole + 7)), LowEnd::Kind::support,
           static_cast<double>(whole));
  }
}

// One in a thousand is lower. ln X of a lognormal is normal with the standard deviation √ln(1 + cv²).
TEST_F(LowEndOfRandomDistributions, ALognormalHasItsQuantile) {
  for (int round = 0; round < rounds; ++round) {
    const double median = uniform(1.0, 500.0), cv = uniform(0.01, 2.0);
    expect(low_end_of(fmt::format("{{lognormal: {{median: {}, cv: {}}}}}", median, cv)), LowEnd::Kind::tail,
           median * std::exp(normal_tail * std::sqrt(std::log1p(cv * cv))));
  }
}

// With the parent's distribution function Φ, P(X ≤ x) = (Φ(x) − Φ(low))/(Φ(high) − Φ(low)) = 0.001.
TEST_F(LowEndOfRandomDistributions, ATruncatedNormalHasItsQuantile) {
  for (int round = 0; round < rounds; ++round) {
    const double mean = uniform(50.0, 200.0), sd = uniform(5.0, 100.0);
    const double low = mean - uniform(0.1, 2.0) * std::min(sd, 0.45 * mean);
    const double high = mean + uniform(0.1, 4.0) * sd;
    const LowEnd found = low_end_of(
        fmt::format("{{truncated_normal: {{mean: {}, sd: {}, low: {}, high: {}}}}}", mean, sd, low, high));
    EXPECT_EQ(found.kind, LowEnd::Kind::tail);
    const auto below = [&](double x) { return boost::math::cdf(standard_normal, (x - mean) / sd); };
    EXPECT_NEAR((below(found.value) - below(low)) / (below(high) - below(low)), 0.001, 1e-9);
    EXPECT_GT(found.value, low);
  }
}

// A plain normal distribution is for values that may have either sign.
TEST_F(LowEndOfRandomDistributions, ANormalHasItsQuantile) {
  for (int round = 0; round < rounds; ++round) {
    const double mean = uniform(-10.0, 10.0), sd = uniform(0.1, 5.0);
    const Study study = study_of(
        minimal_manifest(fmt::format("initial: {{position: {{normal: {{mean: {}, sd: {}}}}}}}\n", mean, sd)));
    const LowEnd found = low_end(study, 0, "initial.position");
    EXPECT_EQ(found.kind, LowEnd::Kind::tail);
    EXPECT_NEAR(found.value, mean + normal_tail * sd, 1e-11 * (std::abs(mean) + sd));
  }
}

// No trial but one in a thousand is drawn below it.
TEST_F(LowEndOfRandomDistributions, HardlyAnyTrialIsLower) {
  constexpr std::int64_t trials = 20'000;
  for (const std::string k1 : {"{lognormal: {median: 110, cv: 0.2}}", "{uniform: [80, 140]}",
                               "{truncated_normal: {mean: 110, sd: 30, low: 20, high: 200}}"}) {
    const Study study =
        study_of(minimal_manifest("friction: {k1: " + k1 + "}\n"), {fmt::format("trials={}", trials)});
    const LowEnd end = low_end(study, 0, "friction.k1");
    std::int64_t lower = 0;
    for (std::int64_t trial = 0; trial < trials; ++trial)
      lower += study_trial(study, 0, trial).inputs[column_of(study, "friction.k1")] < end.value;
    const double expected = end.kind == LowEnd::Kind::tail ? 0.001 * trials : 0.0;
    EXPECT_NEAR(static_cast<double>(lower), expected, 4.0 * std::sqrt(expected)) << k1;
  }
}

TEST(LowEnd, DependsOnTheDesignPoint) {
  const Study study = study_of(
      minimal_manifest("friction: {k1: {uniform: [90, 120]}}\n"
                       "sweep: {cases: {plain: {}, soft: {friction.k1: 40}, loose: {friction.k1: {lognormal: "
                       "{median: 110, cv: 0.1}}}}}\n"));
  EXPECT_EQ(low_end(study, 0, "friction.k1").value, 90.0);
  EXPECT_EQ(low_end(study, 1, "friction.k1").kind, LowEnd::Kind::number);
  EXPECT_EQ(low_end(study, 1, "friction.k1").value, 40.0);
  EXPECT_EQ(low_end(study, 2, "friction.k1").kind, LowEnd::Kind::tail);
}

TEST(LowEnd, AProfileHasNoCommonLowEnd) {
  const Study study = study_of(minimal_manifest(
      "friction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2, marginal: lognormal}}}\n"));
  EXPECT_EQ(low_end(study, 0, "friction.k1").kind, LowEnd::Kind::profile);
}

}  // namespace
}  // namespace zerocount::study
