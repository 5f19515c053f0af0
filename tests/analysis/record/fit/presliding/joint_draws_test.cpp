// Joint draws: their ranks are those of the replicates, their limits those of the intervals, and each is a
// value that a manifest may have.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "analysis/record/fit/presliding/identification.hpp"
#include "core/numerics/interval.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

constexpr double creep_torque = 0.07;

/// Random errors of a bootstrap's replicates, correlated as those of k2 and β are.
Eigen::MatrixXd correlated_errors(Eigen::Index replicates, double size, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto next = [&] { return normal(random); };
  const Eigen::Index columns = fit::contact_dimension + 1;  // with one record's offset
  const Eigen::MatrixXd mixing = Eigen::MatrixXd::NullaryExpr(columns, columns, next);
  return size * Eigen::MatrixXd::NullaryExpr(replicates, columns, next) * mixing;
}

/// The estimated quantities from which a manifest is written, as the identification of a contact gives them.
/// Every second quantity has a profile-likelihood interval that is wider than the interval of the replicates'
/// errors.
/// @param widening factor of the intervals of the errors
std::vector<fit::EstimatedQuantity> estimated_quantities(const fit::ContactParameters& contact,
                                                         const Eigen::MatrixXd& errors, double widening) {
  const fit::Point point = fit::point_of(contact, creep_torque);
  std::vector<fit::EstimatedQuantity> quantities;
  for (const fit::Quantity& quantity : fit::contact_model(creep_torque).quantities_at(point)) {
    if (quantity.key.empty()) continue;
    const auto linear = fit::interval_of_errors(quantity, errors, widening);
    fit::QuantityEstimate profiled = linear;
    if (quantities.size() % 2 == 1) {
      profiled.value = quantity.value;
      profiled.low = quantity.value - 1.3 * (linear.value - linear.low);
      profiled.high = quantity.value + 1.9 * (linear.high - linear.value);
    }
    quantities.push_back({quantity, linear, profiled});
  }
  return quantities;
}

/// The indices of the rows, sorted by their entry in `values`.
std::vector<std::size_t> order_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  return order;
}

TEST(JointDraws, HaveTheRanksOfTheReplicatesWithinTheIntervals) {
  std::mt19937_64 random(92);
  for (const double widening : {1.0, 2.5}) {
    fit::ContactParameters contact = random_contact(random);
    contact.friction.n = 4.0;  // far from its limit, so that no draw is left out
    const Eigen::MatrixXd errors = correlated_errors(999, 0.01, random);
    const auto quantities = estimated_quantities(contact, errors, widening);
    ASSERT_EQ(quantities.size(), 8u);
    fit::JointDraws draws;
    fit::append_draws(quantities, errors, widening, 2000, draws);
    ASSERT_EQ(draws.rows.size(), 999u);
    for (std::size_t j = 0; j < quantities.size(); ++j) {
      const fit::Quantity& quantity = quantities[j].quantity;
      const Eigen::VectorXd own =
          -errors.leftCols<fit::contact_dimension>() * quantity.slope;  // estimate less error
      std::vector<double> drawn;
      for (const std::vector<double>& row : draws.rows)
        drawn.push_back(quantity.logarithmic ? std::log(row[j]) : row[j]);
      EXPECT_EQ(order_of(drawn), order_of({own.data(), own.data() + own.size()})) << quantity.name;
      std::sort(drawn.begin(), drawn.end());
      const auto& reported = quantities[j].reported;
      EXPECT_NEAR(drawn[24], reported.low, 1e-9) << quantity.name;  // of 999, the 2.5 % quantile
      EXPECT_NEAR(drawn[974], reported.high, 1e-9) << quantity.name;
    }
  }
}

TEST(JointDraws, AreValidInAManifest) {
  std::mt19937_64 random(93);
  fit::ContactParameters contact = random_contact(random);
  contact.friction.n = 1.05;
  const Eigen::MatrixXd errors = correlated_errors(500, 0.1, random);
  const auto quantities = estimated_quantities(contact, errors, 1.0);
  fit::JointDraws draws;
  fit::append_draws(quantities, errors, 1.0, 500, draws);
  EXPECT_LT(draws.rows.size(), 450u);  // of the others, n would be below 1
  EXPECT_GT(draws.rows.size(), 200u);
  for (const std::vector<double>& row : draws.rows) {
    for (std::size_t j = 0; j < quantities.size(); ++j) {
      const auto at = parameters::find_parameter(quantities[j].quantity.key);
      ASSERT_TRUE(at.has_value()) << quantities[j].quantity.key;
      EXPECT_TRUE(numerics::contains(parameters::parameter_table()[*at].range, row[j]));
    }
  }
  draws.keys = {"friction.n"};
  EXPECT_NE(fit::reason_of_missing_draws(draws, 500)
                .find(std::to_string(draws.rows.size()) + " of 500 draws are valid"),
            std::string::npos);
  EXPECT_EQ(fit::reason_of_missing_draws(draws, draws.rows.size()), "");
  EXPECT_EQ(fit::reason_of_missing_draws({}, 500), "there is no parameter to draw");
  fit::JointDraws few;
  fit::append_draws(quantities, errors, 1.0, 7, few);
  EXPECT_EQ(few.rows, std::vector(draws.rows.begin(), draws.rows.begin() + 7));
}

TEST(JointErrors, EqualTheCovarianceOfTheReplicates) {
  std::mt19937_64 random(94);
  const Eigen::MatrixXd errors = correlated_errors(300, 0.02, random);
  const auto quantities = estimated_quantities(random_contact(random), errors, 1.0);
  const fit::JointErrors joint = fit::joint_errors(quantities, errors, 3.0);
  ASSERT_EQ(joint.names.size(), quantities.size());
  for (std::size_t j = 0; j < quantities.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    EXPECT_EQ(joint.names[j], quantities[j].quantity.name);
    EXPECT_NEAR(std::sqrt(joint.covariance(at, at)) / (3.0 * quantities[j].by_replicates.standard_error), 1.0,
                1e-9);
    EXPECT_EQ(joint.correlation(at, at), 1.0);
  }
  // λ = σ0ⁿ·exp(−ln(σ0ⁿ/λ)), by the correlation of its two terms and ln k1.
  const auto centred = [&](Eigen::VectorXd values) {
    values.array() -= values.mean();
    return Eigen::VectorXd(values.normalized());
  };
  const Eigen::VectorXd of_lambda =
      errors.col(fit::creep_exponent) * std::log(creep_torque) - errors.col(fit::log_limit);
  EXPECT_EQ(joint.names[6], "lambda");
  EXPECT_NEAR(joint.correlation(0, 6), centred(errors.col(fit::log_k1)).dot(centred(of_lambda)), 1e-9);
}

}  // namespace
}  // namespace zerocount::testing
