// Random histories: by turns up and down, evenly between the last level and the largest torque.
#include "core/trial/random_history.hpp"

#include "tests/support/goodness_of_fit.hpp"
#include "tests/support/test.hpp"

namespace zerocount::trial {
namespace {

constexpr double largest = 0.25;

random::TrialRandomness randomness_of(std::uint64_t trial) {
  random::TrialRandomness randomness;
  randomness.trial = trial;
  randomness.history = {21, 22};
  return randomness;
}

TEST(RandomHistory, IsEmptyWithoutReversals) {
  EXPECT_TRUE(draw_history({0, largest}, randomness_of(1)).empty());
}

TEST(RandomHistory, TurnsAtEveryLevelAndStaysWithinTheTorque) {
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    const std::vector<double> levels = draw_history({12, largest}, randomness_of(trial));
    ASSERT_EQ(levels.size(), 12u);
    double direction = levels[0];
    double last = 0.0;
    for (const double level : levels) {
      ASSERT_GT((level - last) * direction, 0.0);
      ASSERT_LT(std::abs(level), largest);
      direction = -direction;
      last = level;
    }
  }
}

TEST(RandomHistory, FirstDirectionIsEvenAndEveryLevelUniform) {
  constexpr int trials = 20000;
  constexpr std::size_t reversals = 5;
  int upwards = 0;
  std::vector<std::vector<double>> places(
      reversals);  // of each level between the last and the largest torque
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    const std::vector<double> levels =
        draw_history({static_cast<int>(reversals), largest}, randomness_of(trial));
    if (levels[0] > 0.0) ++upwards;
    double outermost = std::copysign(largest, levels[0]);
    double last = 0.0;
    for (std::size_t i = 0; i < reversals; ++i) {
      places[i].push_back((levels[i] - last) / (outermost - last));
      outermost = -outermost;
      last = levels[i];
    }
  }
  EXPECT_NEAR(upwards, trials / 2.0, 3.5 * std::sqrt(trials / 4.0));
  for (const std::vector<double>& values : places) EXPECT_GT(testing::kolmogorov_probability(values), 1e-3);
  for (std::size_t i = 1; i < reversals; ++i) {
    double covariance = 0.0;
    for (std::size_t trial = 0; trial < trials; ++trial)
      covariance += (places[i][trial] - 0.5) * (places[i - 1][trial] - 0.5);
    EXPECT_LT(std::abs(covariance), 4.0 * std::sqrt(trials) / 12.0);
  }
}

}  // namespace
}  // namespace zerocount::trial
