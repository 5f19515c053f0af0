// Strokes and windows: parts of a motion without reversals, stops and masked samples.
#include "analysis/record/sliding_identification/sliding_record.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

using sliding_identification::SlidingRecord;
using sliding_identification::Window;

/// Whether the sample `at` lies in one of the windows of the record, its first and last samples included.
bool in_window(const SlidingRecord& record, std::size_t at) {
  for (const Window& window : record.windows) {
    if (window.first <= at && at <= window.last) return true;
  }
  return false;
}

TEST(SlidingRecords, WindowsHoldNoReversalAndNoStop) {
  std::mt19937_64 random(1);
  const records::RawSeries series = closed_loop_record({}, {}, emps_lap(), 2, random);
  const SlidingRecord record = sliding_identification::sliding_record(series);
  EXPECT_GE(record.strokes.size(), 14u);
  std::size_t used = 0;
  for (const Window& window : record.windows) {
    used += samples_of(window);
    for (std::size_t k = window.first; k < window.last; ++k) {
      ASSERT_GT(window.direction * (series.angle[k + 1] - series.angle[k]), 0.0) << k;
    }
  }
  EXPECT_GT(used, series.time.size() * 9 / 10);
  EXPECT_NEAR(record.resolution, 5e-8, 1e-12);
}

TEST(SlidingRecords, AShorterWindowHoldsTheSameSamples) {
  std::mt19937_64 random(2);
  SlidingRecord record =
      sliding_identification::sliding_record(closed_loop_record({}, {}, emps_lap(), 1, random));
  const auto used = [&] {
    std::size_t sum = 0;
    for (const Window& window : record.windows) sum += samples_of(window);
    return sum;
  };
  const std::size_t all = used();
  const std::size_t windows = record.windows.size();
  cut_windows(record, 32);
  EXPECT_EQ(used(), all);
  EXPECT_GT(record.windows.size(), 5 * windows);
}

TEST(SlidingRecords, MaskedSamplesAreInNoWindow) {
  std::mt19937_64 random(3);
  records::RawSeries series = closed_loop_record({}, {}, emps_lap(), 1, random);
  const SlidingRecord whole = sliding_identification::sliding_record(series);
  ASSERT_TRUE(in_window(whole, 2000));
  EXPECT_TRUE(records::exclude(series, {1.9, 2.1}));
  const SlidingRecord masked = sliding_identification::sliding_record(series);
  for (std::size_t k = 1900; k <= 2100; ++k) ASSERT_FALSE(in_window(masked, k)) << k;
  EXPECT_TRUE(in_window(masked, 1880));
  EXPECT_TRUE(in_window(masked, 2120));
  EXPECT_EQ(masked.strokes.size(), whole.strokes.size() + 1);
  EXPECT_FALSE(records::exclude(series, {1000.0, 1001.0}));
}

TEST(SlidingRecords, NoiseSetsTheResolution) {
  std::mt19937_64 random(4);
  AxisLoop loop;
  loop.noise = 1e-6;
  loop.velocity_gain = 60.0;
  const SlidingRecord record =
      sliding_identification::sliding_record(closed_loop_record({}, loop, emps_lap(), 1, random));
  EXPECT_NEAR(record.resolution / 3e-6, 1.0, 0.05);
}

TEST(SlidingRecords, AConstantForceIsRefused) {
  std::mt19937_64 random(5);
  records::RawSeries series = closed_loop_record({}, {}, emps_lap(), 1, random);
  series.torque.assign(series.torque.size(), 3.0);
  EXPECT_THROW(sliding_identification::sliding_record(series), Failure);
}

}  // namespace
}  // namespace zerocount::testing
