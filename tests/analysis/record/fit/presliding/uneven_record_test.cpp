// Records whose samples come at uneven instants are identified from the instants at which they came.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/record/fit/records/checked_record.hpp"
#include "core/plant/plant.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

/// The record of a simulated test whose samples are 0.3 to 1.7 intervals apart; the torque is held from each
/// sample to the next.
records::RawSeries uneven_series(const fit::ContactParameters& contact, const TorqueProgramme& programme,
                                 std::mt19937_64& random) {
  records::RawSeries series;
  series.name = "uneven.csv";
  series.count_size = 2.0 * std::numbers::pi / 1.62e6;
  const double unit = series.count_size;
  plant::Plant plant(contact.plant, {contact.friction, {}}, {}, {1e-11 * unit});
  double now = 0.0;
  std::uniform_real_distribution<double> part(0.3, 1.7);
  for (const double torque : programme.torque()) {
    series.time.push_back(now);
    series.torque.push_back(torque);
    series.angle.push_back(std::floor(plant.theta() / unit + 0.3));
    const double interval = programme.sample_time() * part(random);
    plant.advance(motion::constant_torque(torque), interval);
    now += interval;
  }
  return series;
}

TEST(UnevenlySampledRecords, GiveTheTrueParameters) {
  std::mt19937_64 random(77);
  fit::ContactParameters truth;
  const records::RawSeries series = uneven_series(truth, short_test().front(), random);
  const fit::TestRecord record = fit::checked_record(series, false);
  ASSERT_FALSE(record.intervals.empty());
  const fit::Identification found = fit::identify({record});
  EXPECT_TRUE(found.checks.passed);
  for (const fit::ParameterEstimate& parameter : found.parameters) {
    ASSERT_EQ(parameter.status, fit::EstimateStatus::estimated) << parameter.name;
    const double value = true_value(truth, parameter.name);
    EXPECT_LT(std::abs(parameter.value - value), 4.0 * parameter.standard_error) << parameter.name;
    if (parameter.name != "time_offset") {
      EXPECT_NEAR(parameter.value / value, 1.0, 0.1) << parameter.name;
    }
  }
}

// A burst of wrong readings, with which the record would be refused. The torque acts all the same.
TEST(MaskedRecords, GiveTheTrueParameters) {
  std::mt19937_64 random(78);
  fit::ContactParameters truth;
  records::RawSeries series = uneven_series(truth, short_test().front(), random);
  for (std::size_t k = 3000; k < 3100; ++k) series.angle[k] += 200.0;
  EXPECT_TRUE(records::exclude(series, {series.time[2999], series.time[3100]}));
  const fit::Identification found = fit::identify({fit::checked_record(series, false)});
  EXPECT_TRUE(found.checks.passed);
  EXPECT_EQ(found.records.front().excluded, 102u);
  for (const fit::ParameterEstimate& parameter : found.parameters) {
    const double value = true_value(truth, parameter.name);
    EXPECT_LT(std::abs(parameter.value - value), 4.0 * parameter.standard_error) << parameter.name;
  }
}

}  // namespace
}  // namespace zerocount::testing
