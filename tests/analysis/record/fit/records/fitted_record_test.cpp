// The record beside the fit, which figures draw.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/record/fit/records/checked_record.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

// What is drawn is what the report sums up: its root mean square is that of the summary.
TEST(FittedRecords, ResidualsGiveTheMisfitOfTheSummary) {
  std::mt19937_64 random(31);
  const fit::ContactParameters contact = random_contact(random);
  std::vector<fit::TestRecord> records;
  for (const TorqueProgramme& programme : three_tests())
    records.push_back(simulated_test(contact, programme, {}, random));
  records[1].excluded.assign(records[1].reading.size(), false);
  for (std::size_t k = 40; k < 60; ++k) records[1].excluded[k] = true;
  fit::IdentificationOptions options;
  options.replicates = 100;
  const fit::Identification found = fit::identify(records, options);
  ASSERT_EQ(found.fitted.size(), records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    const fit::FittedRecord& beside = found.fitted[r];
    double squares = 0.0;
    double used = 0.0;
    for (std::size_t k = 0; k < beside.time.size(); ++k) {
      EXPECT_EQ(beside.reading[k], records[r].reading[k]);
      EXPECT_EQ(beside.torque[k], records[r].torque[k].now);
      if (beside.excluded[k]) continue;
      // The encoder rounds down: without noise a residual is at most half a count, and an error of the fit.
      EXPECT_LT(std::abs(residual(beside, k)), 0.6) << r << " " << k;
      squares += residual(beside, k) * residual(beside, k);
      used += 1.0;
    }
    EXPECT_EQ(beside.time.size() - static_cast<std::size_t>(used), found.records[r].excluded);
    EXPECT_NEAR(std::sqrt(squares / used), found.records[r].misfit, 1e-9);
  }
}

/// A record of angles in rad with these sample times (s), and an arbitrary torque.
records::RawSeries series_at(const std::vector<double>& times) {
  records::RawSeries series;
  series.name = "record";
  series.time = times;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double phase = 0.05 * static_cast<double>(k);
    series.torque.push_back(0.1 * std::sin(phase));
    series.angle.push_back(1e-3 * std::sin(phase - 0.1));
  }
  return series;
}

// The times are those of the file, which --exclude takes. Masked readings are drawn as they were read.
TEST(FittedRecords, HaveTheTimesAndReadingsOfTheFile) {
  std::mt19937_64 random(32);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  for (const bool even : {true, false}) {
    std::vector<double> times;
    for (std::size_t k = 0; k < 400; ++k)
      times.push_back(7.5 + 1e-3 * (static_cast<double>(k) + (even || k == 0 ? 0.0 : jitter(random))));
    records::RawSeries series = series_at(times);
    series.angle[200] = 0.3;
    EXPECT_TRUE(records::exclude(series, {times[199], times[201]}));
    const fit::TestRecord record = fit::checked_record(series, true);
    EXPECT_EQ(record.intervals.empty(), even);
    const fit::FittedRecord beside = fit::fitted_record(record, Eigen::VectorXd::Constant(400, 2.0));
    for (std::size_t k = 0; k < times.size(); ++k) {
      EXPECT_NEAR(beside.time[k], times[k], 1e-9) << k;
      EXPECT_NEAR(beside.reading[k] * record.unit, series.angle[k] - series.angle[0], 1e-12) << k;
      EXPECT_EQ(beside.excluded[k], k >= 199 && k <= 201) << k;
      EXPECT_EQ(beside.fitted[k], 2.0 - fit::middle_of_reading(record));
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
