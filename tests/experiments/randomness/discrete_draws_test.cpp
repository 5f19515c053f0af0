// A discrete draw is known value by value: which one is drawn at given coordinates, and coordinates that draw
// a given one.
#include "experiments/randomness/discrete_draws.hpp"

#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::randomness {
namespace {

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

TEST_F(DiscreteDraws, AreThoseOfChoicesAndIntegers) {
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

TEST_F(DiscreteDraws, HaveTheValueOfTheTrial) {
  std::mt19937_64 numbers(3);
  for (int i = 0; i < 300; ++i) {
    const std::vector<double> z = normals_of(numbers, coordinates_.size());
    for (const DiscreteDraw& draw : draws_)
      EXPECT_EQ(value_in_trial(draw, z), value_text(draw, value_at(draw, z))) << draw.name;
  }
}

// Points moved to the rows in turn are as those that are drawn: every coordinate keeps its distribution.
TEST_F(DiscreteDraws, AreMovedToAnyRow) {
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

TEST(DiscreteDrawsOfSamples, AreTheirRows) {
  const DiscreteDraw draw{.name = "samples", .direction = {{0, 1.0}}, .rows = 20};
  EXPECT_EQ(draw.values(), 20);
  EXPECT_EQ(value_text(draw, 17), "row 17");
}

}  // namespace
}  // namespace zerocount::randomness
