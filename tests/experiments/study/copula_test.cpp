// Correlated parameters: the correlation of their normal scores is the stated one, and each keeps its
// distribution, whatever the design and however often they are drawn.
#include "experiments/study/copula.hpp"

#include <Eigen/LU>
#include <boost/math/distributions/normal.hpp>

#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::study {
namespace {

const std::string three_uniform =
    "friction: {k1: {uniform: [100, 101]}, k2: {uniform: [700, 701]}, beta: {uniform: [100000, 100001]}}\n";
const std::string two_pairs =
    "correlation: [[friction.k2, friction.k1, 0.6], [friction.k1, friction.beta, -0.5]]\n";

/// Uniform numbers of the three parameters, each [trial or rig].
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

/// The largest difference of the empirical distribution function from that of the uniform numbers.
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

TEST(Copula, IsThatOfRigsWhereTheParametersAreDrawnPerRig) {
  constexpr std::int64_t rigs = 4000;
  const Study study = study_of(minimal_manifest(three_uniform + two_pairs), {"rigs=4000", "trials=8000"});
  const std::vector<std::vector<double>> u = uniforms(study, rigs);
  EXPECT_NEAR(correlation_of_scores(u[0], u[1]), 0.6, 4.0 / std::sqrt(double(rigs)));
  for (const std::int64_t rig : {0, 17, 3999}) {
    const StudyTrial first = study_trial(study, 0, rig);
    EXPECT_EQ(first.inputs, study_trial(study, 0, rig + rigs).inputs);
    EXPECT_EQ(first.inputs, rig_inputs(study, rig));
  }
}

TEST(Copula, LeavesTheFirstParameterAndTheUncorrelatedOnesAsTheyAre) {
  const std::string with_lambda = three_uniform + "initial: {position: {uniform: [0, 6]}}\n";
  const Study plain = study_of(minimal_manifest(with_lambda));
  const Study correlated = study_of(minimal_manifest(with_lambda + two_pairs));
  for (const char* name : {"friction.k1", "initial.position"}) {
    const std::size_t column = column_of(plain, name);
    for (std::int64_t i = 0; i < 5; ++i) {
      EXPECT_EQ(study_trial(plain, 0, i).inputs[column], study_trial(correlated, 0, i).inputs[column]);
    }
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

TEST(Copula, FactorGivesItsMatrixAndExistsForPositiveDefiniteOnesOnly) {
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

}  // namespace
}  // namespace zerocount::study
