// What the checks between parameters look at: every combination of values that meets at some point.
#include "experiments/study/point_limits.hpp"

#include "experiments/study/point_label.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

using Combination = std::vector<double>;

Combination combination_at(const StudyPlan& plan, const std::vector<std::size_t>& slots, std::size_t point) {
  Combination values;
  for (const ParameterRange& range : ranges_at(plan, slots, point)) values.push_back(range.low);
  return values;
}

Study swept_study() {
  return study_of(manifest_commanding(
      "{targets: [1, 2]}",
      "sweep:\n"
      "  cases: {a: {controller.kp: 1, dac.bits: 10}, b: {dac.bits: 11}, c: {}}\n"
      "  grid: {controller.ki: [0, 1, 2], command.targets.1: [7, 8], controller.kp: [5, 6], "
      "plant.inertia: [1, 2]}\n"));
}

TEST(PointVisits, EveryCombinationIsVisited) {
  const Study study = swept_study();
  const std::vector<std::string_view> names{"controller.kp", "dac.bits", "controller.ki", "plant.inertia",
                                            "controller.kd"};
  const std::vector<std::size_t> named = slots_named(study.plan->table, names);
  for (std::size_t mask = 0; mask < (std::size_t{1} << names.size()); ++mask) {
    std::vector<std::size_t> slots{study.plan->list.first + 1};
    for (std::size_t i = 0; i < named.size(); ++i) {
      if ((mask >> i & 1) != 0) slots.push_back(named[i]);
    }
    std::set<Combination> all;
    for (std::size_t point = 0; point < study.points.labels.size(); ++point)
      all.insert(combination_at(*study.plan, slots, point));
    std::set<Combination> visited;
    visit_points(*study.plan, slots, [&](std::size_t point) {
      EXPECT_LT(point, study.points.labels.size());
      visited.insert(combination_at(*study.plan, slots, point));
      return true;
    });
    ASSERT_EQ(visited, all) << mask;
  }
}

TEST(PointVisits, ParametersThatAreNotNamedAreSkipped) {
  const Study study = swept_study();
  const auto visits = [&](std::vector<std::string_view> names) {
    std::size_t count = 0;
    visit_points(*study.plan, slots_named(study.plan->table, names), [&](std::size_t) {
      ++count;
      return true;
    });
    return count;
  };
  EXPECT_EQ(visits({"friction.k1"}), 1u);
  EXPECT_EQ(visits({"controller.ki"}), 3u);
  EXPECT_EQ(visits({"controller.ki", "plant.inertia"}), 6u);
  EXPECT_EQ(visits({}), 1u);
}

TEST(PointVisits, AVisitMayEndEarly) {
  const Study study = swept_study();
  std::size_t count = 0;
  visit_points(*study.plan, slots_of(study.plan->list), [&](std::size_t) { return ++count < 2; });
  EXPECT_EQ(count, 2u);
}

ParameterRange range_of_velocity(const std::string& velocity) {
  const Study study = study_of(minimal_manifest("initial: {velocity: " + velocity + "}\n"));
  const std::vector<std::string_view> name{"initial.velocity"};
  return ranges_at(*study.plan, slots_named(study.plan->table, name), 0).front();
}

TEST(PointRanges, AreTheSupportAndKnowWhetherItContainsZero) {
  EXPECT_EQ(range_of_velocity("0.5").low, 0.5);
  EXPECT_FALSE(range_of_velocity("0.5").can_be_zero);
  EXPECT_TRUE(range_of_velocity("0").can_be_zero);
  EXPECT_EQ(range_of_velocity("{uniform: [-1, 2]}").low, -1);
  EXPECT_EQ(range_of_velocity("{uniform: [-1, 2]}").high, 2);
  EXPECT_TRUE(range_of_velocity("{uniform: [0, 1]}").can_be_zero);
  EXPECT_FALSE(range_of_velocity("{uniform: [-1, 0]}").can_be_zero) << "the upper end is not drawn";
  EXPECT_FALSE(range_of_velocity("{choice: [-1, 1]}").can_be_zero);
  EXPECT_TRUE(range_of_velocity("{choice: [-1, 0, 1]}").can_be_zero);
  EXPECT_FALSE(range_of_velocity("{lognormal: {median: 1, cv: 1}}").can_be_zero);
  EXPECT_TRUE(range_of_velocity("{integers: [-1, 1]}").can_be_zero);
}

// A list of values need not be in their order.
TEST(PointRanges, AChoiceHasItsLowestHighestAndMedianValue) {
  const Study study = study_of(minimal_manifest("friction: {k1: {choice: [500, 50, 90, 600, 70]}}\n"));
  const std::size_t slot =
      slots_named(study.plan->table, std::vector<std::string_view>{"friction.k1"}).front();
  EXPECT_EQ(extremes_of(*study.plan, slot, 0), (std::pair{50.0, 600.0}));
  const ParameterRange range = range_of_slot(*study.plan, slot, 0);
  EXPECT_EQ(range.low, 50.0);
  EXPECT_EQ(range.high, 600.0);
  EXPECT_EQ(range.typical, 90.0);
}

}  // namespace
}  // namespace zerocount::study

namespace zerocount::testing {
namespace {

const std::vector<std::string> labels{"controller.kp=0, controller.ki=5000",
                                      "controller.kp=0, controller.ki=1e+04", "a b, controller.coarse.kp=1",
                                      "2 c", "1"};

TEST(PointLabel, NamesAPointByNumberLabelOrTableText) {
  for (const char* const name : {"controller.kp=0, controller.ki=5000", "0", "kp=0 ki=5000", "kp=0, ki=5000",
                                 "0 (kp=0 ki=5000)", "controller.kp=0 controller.ki=5000"})
    EXPECT_EQ(study::point_named(name, labels), 0) << name;
  EXPECT_EQ(study::point_named("a b kp=1", labels), 2);
  EXPECT_EQ(study::point_named("a b coarse.kp=1", labels), 2);
  EXPECT_EQ(study::point_named("3", labels), 3);
  EXPECT_EQ(study::point_named("1", labels), 1);  // the number, though point 4 has this label
}

TEST(PointLabel, NamesOnePointOrNone) {
  for (const char* const name : {"", "5", "-1", "ki=5000", "1 (kp=0 ki=5000)", "9 (kp=0 ki=5000)", "kp=0"})
    EXPECT_EQ(study::point_named(name, labels), std::nullopt) << name;
  const std::vector<std::string> alike{"controller.kp=1", "controller.coarse.kp=1"};
  EXPECT_EQ(study::point_named("kp=1", alike), std::nullopt);
  EXPECT_EQ(study::point_named("coarse.kp=1", alike), 1);
  EXPECT_EQ(study::point_named("oarse.kp=1", alike), std::nullopt);
}

}  // namespace
}  // namespace zerocount::testing
