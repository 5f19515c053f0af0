// One record under two names.
#include "analysis/record/records/equal_series.hpp"

#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using records::are_equal;
using records::RawSeries;

/// A random record in counts.
RawSeries random_series(unsigned seed, std::size_t samples) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> torques(-1.0, 1.0);
  RawSeries series;
  series.count_size = 1e-5;
  for (std::size_t k = 0; k < samples; ++k) {
    series.time.push_back(1e-3 * static_cast<double>(k));
    series.torque.push_back(torques(generator));
    series.angle.push_back(static_cast<double>(generator() % 1000));
  }
  return series;
}

/// The record with the same readings written differently: at shifted times, in rad from another zero, with
/// twelve digits.
RawSeries otherwise(RawSeries series) {
  for (double& time : series.time) time = std::stod(fmt::format("{:.12g}", time + 2.5));
  for (double& torque : series.torque) torque = std::stod(fmt::format("{:.12g}", torque));
  for (double& angle : series.angle)
    angle = std::stod(fmt::format("{:.12g}", series.count_size * angle + 0.25));
  series.count_size = 0.0;
  return series;
}

RawSeries first_samples(RawSeries series, std::size_t samples) {
  for (std::vector<double>* values : {&series.time, &series.torque, &series.angle}) values->resize(samples);
  return series;
}

TEST(EqualSeries, OtherUnitsAndMoreSamplesAreStillEqual) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RawSeries series = random_series(seed, 300);
    EXPECT_TRUE(are_equal(series, series));
    EXPECT_TRUE(are_equal(series, otherwise(series)));
    EXPECT_TRUE(are_equal(otherwise(series), first_samples(series, 200))) << "a record that went on";
  }
}

TEST(EqualSeries, OneDifferentReadingMakesThemDiffer) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RawSeries series = random_series(seed, 300);
    RawSeries other = series;
    other.angle[150] += 1.0;
    EXPECT_FALSE(are_equal(series, other));
    other = series;
    other.torque[7] += 1e-6;
    EXPECT_FALSE(are_equal(series, other));
    other = series;
    for (double& time : other.time) time *= 1.001;
    EXPECT_FALSE(are_equal(series, other));
    EXPECT_FALSE(are_equal(series, random_series(seed + 100, 300)));
  }
}

}  // namespace
}  // namespace zerocount::testing
