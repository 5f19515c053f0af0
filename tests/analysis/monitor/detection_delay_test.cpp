// The moves after which a change would have been seen.
#include "analysis/monitor/detection_delay.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/monitor/move_sequences.hpp"

namespace zerocount::testing {
namespace {

using monitor::Direction;
using Directions = std::vector<Direction>;
using Values = std::vector<double>;

/// The change of values that are all alike.
struct Change {
  double size;
  Directions directions;
};

monitor::MonitoredMeasure measure(std::string_view name) {
  return *monitor::measure_named(name);
}

Change change_to_see(const monitor::MonitoredMeasure& measure, const Values& values,
                     std::optional<double> change) {
  const monitor::ChangeToSee to_see = monitor::change_to_see(measure, std::vector<Values>{values}, change);
  return {to_see.sizes.at(0), to_see.directions};
}

TEST(ChangeToSee, IsAPartOfTheMedianOrOfAProportion) {
  const Directions both{Direction::higher, Direction::lower};
  const Change time = change_to_see(measure("settling_time"), Values{0.04, 0.05, 0.06}, {});
  EXPECT_NEAR(time.size, 0.01, 1e-15);
  EXPECT_EQ(time.directions, both);
  EXPECT_NEAR(change_to_see(measure("settling_time"), Values{0.05}, 0.5).size, 0.025, 1e-15);
  const Change large = change_to_see(measure("settling_time"), Values{0.04, 0.05, 0.06}, 1.5);
  EXPECT_NEAR(large.size, 0.075, 1e-15);
  EXPECT_EQ(large.directions, Directions{Direction::higher}) << "no time is negative";
  const Change good = change_to_see(measure("outcome"), Values{1.0, 1.0, 1.0, 0.0}, {});
  EXPECT_EQ(good.size, 0.1);
  EXPECT_EQ(good.directions, both);
  EXPECT_EQ(change_to_see(measure("stable"), Values{1.0}, {}).directions, Directions{Direction::lower});
}

TEST(ChangeToSee, IsNotAskedOfWhatHasNoScale) {
  EXPECT_TRUE(change_to_see(measure("holding_torque"), Values{-1.0, 1.0, 2.0}, {}).directions.empty());
  EXPECT_TRUE(
      change_to_see(measure("settling_time"), Values{1.0, HUGE_VAL, HUGE_VAL}, {}).directions.empty());
  EXPECT_TRUE(change_to_see(measure("jerk_count"), Values{0.0, 0.0, 3.0}, {}).directions.empty());
  EXPECT_FALSE(change_to_see(measure("holding_torque"), Values{1.0, 1.0, 2.0}, {}).directions.empty());
}

// Of a move to a far target a fifth is more than of one to a near target.
TEST(ChangeToSee, IsAPartOfTheMedianOfEachClass) {
  const std::vector<Values> classes{{0.02, 0.02, 0.03}, {0.2}, {HUGE_VAL}};
  const monitor::ChangeToSee to_see = monitor::change_to_see(measure("settling_time"), classes, {});
  ASSERT_EQ(to_see.sizes.size(), 3);
  EXPECT_NEAR(to_see.sizes[0], 0.004, 1e-15);
  EXPECT_NEAR(to_see.sizes[1], 0.04, 1e-15);
  EXPECT_EQ(to_see.sizes[2], 0.0) << "what never happens cannot change so much";
  EXPECT_EQ(to_see.directions.size(), 2);
}

std::optional<std::int64_t> asked(const Values& baseline, Direction direction, double size,
                                  double alarm = 1000.0, std::string_view name = "settling_time") {
  const monitor::MonitoredMeasure of = measure(name);
  const std::vector<Values> classes{baseline};
  const Values sizes{size};
  return monitor::values_to_see({.measure = of,
                                 .baseline = classes,
                                 .direction = direction,
                                 .sizes = sizes,
                                 .alarm = alarm,
                                 .max_values = 2000,
                                 .seed = 1});
}

Values sorted_values(Moves kind, std::int64_t count, std::uint32_t number) {
  random::NumberSource numbers = numbers_of("delays", number);
  Values values;
  for (std::int64_t i = 0; i < count; ++i) values.push_back(move_value(kind, numbers));
  std::ranges::sort(values);
  return values;
}

TEST(ValuesToSee, AreMoreForSmallerChangesAndRarerAlarms) {
  const Values baseline = sorted_values(Moves::lognormal, 300, 1);
  const std::int64_t usual = asked(baseline, Direction::lower, 0.01).value();
  EXPECT_LT(asked(baseline, Direction::lower, 0.02).value(), usual);
  EXPECT_GT(asked(baseline, Direction::lower, 0.01, 1e6).value(), usual);
  EXPECT_FALSE(asked(baseline, Direction::lower, 0.0005));
  EXPECT_FALSE(asked(sorted_values(Moves::lognormal, 4, 2), Direction::lower, 0.01));
}

// A real sequence with that change, of the distribution that the baseline came from, is seen as often.
TEST(ValuesToSee, IsWhatRealSequencesTake) {
  for (const Moves kind : {Moves::lognormal, Moves::binary}) {
    const Values baseline = sorted_values(kind, 500, 3);
    const double size = kind == Moves::binary ? 0.1 : 0.01;
    const std::string_view name = kind == Moves::binary ? "stable" : "settling_time";
    const std::int64_t values = asked(baseline, Direction::lower, size, 1000.0, name).value();
    int seen = 0;
    constexpr int sequences = 200;
    for (std::uint32_t i = 0; i < sequences; ++i) {
      random::NumberSource numbers = numbers_of("real", i);
      monitor::ChangeTest test(sorted_values(kind, 500, 100 + i), {5, 6});
      for (std::int64_t t = 0; t < values && test.martingale().capital() < 1000.0; ++t) {
        const double before = move_value(kind, numbers, kind == Moves::binary ? 0.85 / 0.95 : 1.0);
        test.update(kind == Moves::binary ? before : before - size);
      }
      seen += test.martingale().capital() >= 1000.0 ? 1 : 0;
    }
    EXPECT_GE(seen, 0.83 * sequences) << name_of(kind);
    EXPECT_LE(seen, 0.97 * sequences) << name_of(kind);
  }
}

}  // namespace
}  // namespace zerocount::testing
