// Gaps in the times of a record.
#include "experiments/tables/time_gaps.hpp"

#include "tests/support/test.hpp"

namespace zerocount::tables {
namespace {

/// Times (s) of a record whose steps from row to row are these.
std::vector<double> times_of(const std::vector<double>& steps) {
  std::vector<double> times{0.0};
  for (const double step : steps) times.push_back(times.back() + step);
  return times;
}

std::vector<std::size_t> rows_of(const std::vector<double>& steps) {
  std::vector<std::size_t> rows;
  for (const TimeGap& gap : time_gaps(times_of(steps))) rows.push_back(gap.row);
  return rows;
}

std::vector<double> random_steps(std::size_t count, double spread, std::mt19937& generator) {
  std::uniform_real_distribution<double> steps(1.0 - spread, 1.0 + spread);
  std::vector<double> drawn(count);
  for (double& step : drawn) step = 1e-3 * steps(generator);
  return drawn;
}

// Whatever the jitter of the steps and the place of the gaps.
TEST(TimeGaps, AreFoundWhereRowsAreMissing) {
  std::mt19937 generator(11);
  for (int record = 0; record < 200; ++record) {
    std::vector<double> steps = random_steps(400, 0.5, generator);
    const std::size_t first = generator() % 200;
    const std::size_t second = first + 1 + generator() % 199;
    steps[first] = 0.05;
    steps[second] = 0.02;
    EXPECT_EQ(rows_of(steps), (std::vector{first + 1, second + 1})) << record;
  }
}

TEST(TimeGaps, ReportTheLostTimeAndTheUsualStep) {
  std::vector<double> steps(1000, 1e-3);
  steps[499] = 0.051;
  const std::vector<TimeGap> gaps = time_gaps(times_of(steps));
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_EQ(gaps[0].row, 500u);
  EXPECT_NEAR(gaps[0].step, 0.051, 1e-12);
  EXPECT_NEAR(gaps[0].usual, 1e-3, 1e-12);
}

TEST(TimeGaps, UnevenStepsAreNotGaps) {
  std::mt19937 generator(5);
  for (int record = 0; record < 200; ++record)
    EXPECT_TRUE(rows_of(random_steps(500, 0.9, generator)).empty()) << record;
}

// Rows that follow a rule have no gap: a change of the rate, growing steps, bursts, and few rows.
TEST(TimeGaps, RegularPatternsAreNotGaps) {
  std::vector<double> rates(300, 1e-3);
  rates.insert(rates.end(), 100, 0.1);
  rates.insert(rates.end(), 100, 2e-3);
  EXPECT_TRUE(rows_of(rates).empty());
  std::vector<double> growing;
  for (int i = 0; i < 60; ++i) growing.push_back(1e-6 * std::pow(1.3, i));
  EXPECT_TRUE(rows_of(growing).empty());
  for (const int burst : {2, 5, 10, 25}) {
    std::vector<double> bursts;
    for (int i = 0; i < 1000; ++i) bursts.push_back(i % burst == burst - 1 ? 0.05 : 1e-3);
    EXPECT_TRUE(rows_of(bursts).empty()) << burst;
  }
  EXPECT_TRUE(rows_of({0.1, 0.1, 0.1, 5.0, 0.1, 0.1}).empty()) << "corners of a path";
  EXPECT_TRUE(time_gaps(std::vector<double>{}).empty());
}

}  // namespace
}  // namespace zerocount::tables
