// The measures against OpenTURNS and SciPy on the same samples, and against what is known of test functions.
#include <nlohmann/json.hpp>

#include "analysis/trials/sensitivity/correlations.hpp"
#include "analysis/trials/sensitivity/sobol_indices.hpp"
#include "experiments/designs/designs.hpp"
#include "tests/analysis/trials/sensitivity/test_functions.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sensitivity {
namespace {

using Json = nlohmann::json;
using Points = std::vector<std::vector<double>>;

Json json_of(const BoundedNumber& number) {
  return {{"value", number.value}, {"low", number.low}, {"high", number.high}};
}

void expect_agreement(const std::string& judge, const Json& cases) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "cases.json") << cases.dump();
  const std::string command =
      fmt::format("{} {} {} {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_SENSITIVITY_JUDGE, judge,
                  (folder / "cases.json").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(folder.read("out"), fmt::format("{} cases\n", cases.size()));
}

struct DesignCase {
  std::string name;
  testing::UnitFunction function;
  std::vector<double> first_orders;
  std::vector<double> totals;
};

std::vector<DesignCase> design_cases() {
  return {{"Ishigami", testing::ishigami, testing::ishigami_first_orders(), testing::ishigami_totals()},
          {"g-function of 3", testing::g_function, testing::g_first_orders(3), testing::g_totals(3)},
          {"g-function of 5", testing::g_function, testing::g_first_orders(5), testing::g_totals(5)}};
}

std::vector<SobolIndices> indices_of(const SaltelliSample& sample, double confidence) {
  return saltelli_indices(sample, confidence, {designs::random_key(3, "bootstrap"), 0});
}

TEST(SensitivityJudges, SobolIndicesAgreeWithOpenTurns) {
  Json cases = Json::array();
  for (const DesignCase& known : design_cases()) {
    const std::size_t factors = known.totals.size();
    const Points points = testing::drawn_points("saltelli", factors, 2000 * (factors + 2), 20020721);
    const SaltelliSample sample = testing::sample_of(known.function, points);
    Json json{
        {"name", known.name}, {"a", sample.a}, {"b", sample.b}, {"c", sample.c}, {"points_c", Json::array()}};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t place = i % (factors + 2);
      if (place < 2) json[place == 0 ? "points_a" : "points_b"].push_back(points[i]);
      if (place >= 2) json["points_c"][place - 2].push_back(points[i]);
    }
    for (const SobolIndices& indices : indices_of(sample, 0.95)) {
      json["first_order"].push_back(json_of(indices.first_order));
      json["total"].push_back(json_of(indices.total));
    }
    cases.push_back(json);
  }
  expect_agreement("design", cases);
}

// The bounds of 99 % cover what is known; with 100 000 rows, the error is below 0.02.
TEST(SensitivityJudges, SobolIndicesMatchTheKnownTestFunctions) {
  for (const DesignCase& known : design_cases()) {
    const std::size_t factors = known.totals.size();
    for (const std::size_t rows : {1000UL, 100000UL}) {
      const Points points = testing::drawn_points("saltelli", factors, rows * (factors + 2), 4);
      const auto indices = indices_of(testing::sample_of(known.function, points), 0.99);
      for (std::size_t j = 0; j < factors; ++j) {
        const std::string place = fmt::format("{}, factor {}, {} rows", known.name, j, rows);
        EXPECT_LE(indices[j].first_order.low, known.first_orders[j]) << place;
        EXPECT_GE(indices[j].first_order.high, known.first_orders[j]) << place;
        EXPECT_LE(indices[j].total.low, known.totals[j]) << place;
        EXPECT_GE(indices[j].total.high, known.totals[j]) << place;
        if (rows == 1000) continue;
        EXPECT_NEAR(indices[j].first_order.value, known.first_orders[j], 0.02) << place;
        EXPECT_NEAR(indices[j].total.value, known.totals[j], 0.02) << place;
      }
    }
  }
}

// Of any design of these, the proportion explained alone; that of Ishigami's third factor is 0.
TEST(SensitivityJudges, GivenDataIndicesMatchTheKnownTestFunctions) {
  for (const DesignCase& known : design_cases()) {
    for (const char* design : {"monte_carlo", "latin_hypercube", "sobol"}) {
      const Points points = testing::drawn_points(design, known.totals.size(), 20000, 5);
      for (std::size_t j = 0; j < known.totals.size(); ++j) {
        std::vector<double> x;
        std::vector<double> y;
        for (const std::vector<double>& point : points) {
          x.push_back(point[j]);
          y.push_back(known.function(point));
        }
        EXPECT_NEAR(given_data_first_order(x, y, 0.95).value, known.first_orders[j], 0.03)
            << known.name << ", " << design << ", factor " << j;
      }
    }
  }
}

struct PlainSample {
  Eigen::MatrixXd x;
  std::vector<double> y;
};

PlainSample plain_sample(const Points& points, const testing::UnitFunction& function, bool rounded) {
  PlainSample sample{Eigen::MatrixXd(points.size(), points.front().size()), {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points[i].size(); ++j) {
      const double value = rounded ? std::floor(6.0 * points[i][j]) : points[i][j];
      sample.x(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value;
    }
    const double value = function(points[i]);
    sample.y.push_back(rounded ? std::floor(value) : value);
  }
  return sample;
}

TEST(SensitivityJudges, RankCorrelationsAgreeWithSciPyAndOpenTurns) {
  Json cases = Json::array();
  for (const DesignCase& known : design_cases()) {
    for (const bool rounded : {false, true}) {
      const Points points = testing::drawn_points("monte_carlo", known.totals.size(), 700, 6);
      const PlainSample sample = plain_sample(points, known.function, rounded);
      Json json{{"name", known.name}, {"y", sample.y}, {"without_ties", !rounded}};
      const auto partial = partial_rank_correlations(sample.x, sample.y, 0.95);
      for (std::size_t j = 0; j < known.totals.size(); ++j) {
        const auto column = sample.x.col(static_cast<Eigen::Index>(j));
        const std::vector<double> x(column.begin(), column.end());
        json["x"].push_back(x);
        json["rank_correlation"].push_back(rank_correlation(x, sample.y, 0.95).value);
        json["partial_rank_correlation"].push_back(partial[j].value);
        json["first_order"].push_back(given_data_first_order(x, sample.y, 0.95).value);
      }
      cases.push_back(json);
    }
  }
  expect_agreement("sample", cases);
}

TEST(SensitivityJudges, LogisticFitsAgreeWithAGeneralMinimiser) {
  Json cases = Json::array();
  for (const double threshold : {0.9, 1.1, 2.0}) {
    const Points points = testing::drawn_points("monte_carlo", 5, 500, 8);
    PlainSample sample = plain_sample(
        points, [&](auto u) { return u[0] + u[1] * u[1] - 0.5 * u[2] + 2.0 * u[4] > threshold ? 1.0 : 0.0; },
        false);
    sample.x.conservativeResize(Eigen::NoChange, 4);  // the fifth is not known to the fit
    const Eigen::VectorXd yes = Eigen::VectorXd::Map(sample.y.data(), std::ssize(sample.y));
    const LogisticFit fit = logistic_fit(sample.x, yes, 0.95);
    ASSERT_EQ(fit.status, LogisticFit::Status::fitted);
    Json json{
        {"name", fmt::format("above {}", threshold)}, {"yes", sample.y}, {"found", {json_of(fit.intercept)}}};
    for (Eigen::Index j = 0; j < sample.x.cols(); ++j) {
      json["x"].push_back(std::vector<double>(sample.x.col(j).begin(), sample.x.col(j).end()));
      json["found"].push_back(json_of(fit.slopes[static_cast<std::size_t>(j)]));
    }
    cases.push_back(json);
  }
  expect_agreement("logistic", cases);
}

}  // namespace
}  // namespace zerocount::sensitivity
