// How often a comparison is wrong, and how often it sees what there is, by simulation.
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "tests/analysis/pairs/comparison/synthetic_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t pair_trials = 150;
constexpr std::array<SyntheticPoint, 5> points{
    {{0.95, 0.02, 0.1}, {0.7, 0.03, 0.5}, {0.5, 0.05, 1.0}, {0.15, 0.01, 0.2}, {1.0, 0.03, 0.0}}};

/// Simulates two studies with the same made-up design points and compares them. `change` converts the points
/// of the first study to those of the second.
std::vector<comparison::PointComparison> compare_once(
    std::mt19937_64& random, bool paired, const comparison::GateRules& rules,
    const std::function<SyntheticPoint(SyntheticPoint)>& change, std::int64_t count = pair_trials) {
  const TrialChances before = draw_chances(random, count);
  const TrialChances after = paired ? redraw_some(random, before, 0.2) : draw_chances(random, count);
  std::vector<comparison::PointComparison> compared;
  for (const SyntheticPoint& point : points) {
    comparison::PointComparison one;
    one.baseline_trials = one.current_trials = count;
    one.judgements = comparison::compare_measures(
        rules, "", {synthetic_trials(point, before), synthetic_trials(change(point), after), paired});
    compared.push_back(std::move(one));
  }
  comparison::decide(comparison::judgements_of(compared), rules);
  return compared;
}

bool any(const std::vector<comparison::PointComparison>& compared,
         const std::function<bool(const comparison::Judgement&)>& is) {
  return std::any_of(compared.begin(), compared.end(), [&](const comparison::PointComparison& point) {
    return std::any_of(point.judgements.begin(), point.judgements.end(), is);
  });
}

bool failed(const comparison::Judgement& measure) {
  return measure.verdict == comparison::GateVerdict::regression;
}

SyntheticPoint unchanged(SyntheticPoint point) {
  return point;
}

/// Rules whose margins are all 0, so that only the control of false discoveries protects from false alarms.
comparison::GateRules without_margins(double rate) {
  comparison::GateRules rules;
  rules.false_discovery_rate = rate;
  for (const comparison::GateMeasure& measure : comparison::gate_measures())
    rules.margins[std::string(measure.name)] = {};
  return rules;
}

class NullComparisons : public ::testing::TestWithParam<bool> {};

void expect_false_alarms_as_stated(bool paired, int comparisons) {
  std::mt19937_64 random(41);
  const comparison::GateRules rules = without_margins(0.2);  // so that there is something to count
  int alarms = 0;
  int improvements = 0;
  for (int i = 0; i < comparisons; ++i) {
    const auto compared = compare_once(random, paired, rules, unchanged);
    alarms += any(compared, failed);
    improvements += any(compared, [](const comparison::Judgement& m) {
      return m.change == comparison::ChangeVerdict::better;
    });
  }
  ::testing::Test::RecordProperty("alarms", alarms);
  EXPECT_LE(alarms, comparisons * 0.2);
  EXPECT_LE(improvements, comparisons * 0.2);
  EXPECT_GT(alarms, 0);  // the level is used, not only kept
}

TEST_P(NullComparisons, RaiseFalseAlarmsNoMoreOftenThanStated) {
  expect_false_alarms_as_stated(GetParam(), 150);
}

void expect_hardly_any_at_the_defaults(bool paired, int comparisons) {
  std::mt19937_64 random(43);
  int alarms = 0;
  for (int i = 0; i < comparisons; ++i) alarms += any(compare_once(random, paired, {}, unchanged), failed);
  ::testing::Test::RecordProperty("alarms", alarms);
  EXPECT_LE(alarms, comparisons * 0.05);
}

TEST_P(NullComparisons, DefaultMarginsRaiseHardlyAnyFalseAlarm) {
  expect_hardly_any_at_the_defaults(GetParam(), 150);
}

// A change of exactly the margin must not pass as none more often than the bounds allow.
void expect_a_change_of_the_margin_to_fail(bool paired, int comparisons) {
  std::mt19937_64 random(47);
  comparison::GateRules rules;
  rules.margins["success_rate"] = {0.05, 0.0, false};
  rules.margins["arrival_time"] = {0.2 * points[1].settling, 0.0, false};
  rules.margins["jerk_count"] = {0.0, 0.0, false};
  std::array<int, 2> passed{};  // of success and settling time, at the second point
  for (int i = 0; i < comparisons; ++i) {
    const auto compared = compare_once(random, paired, rules, [](SyntheticPoint point) {
      return SyntheticPoint{point.success - 0.05, 1.2 * point.settling, point.jerks};
    });
    passed[0] += compared[1].judgements[0].verdict == comparison::GateVerdict::passed;
    passed[1] += compared[1].judgements[3].verdict == comparison::GateVerdict::passed;
  }
  const double allowed = 0.05 + 2.5 * std::sqrt(0.05 * 0.95 / comparisons);
  ::testing::Test::RecordProperty("passed_success", passed[0]);
  ::testing::Test::RecordProperty("passed_settling", passed[1]);
  EXPECT_LE(passed[0], comparisons * allowed);
  EXPECT_LE(passed[1], comparisons * allowed);
}

TEST_P(NullComparisons, PassAChangeOfTheMarginNoMoreOftenThanStated) {
  expect_a_change_of_the_margin_to_fail(GetParam(), 100);
}

/// Proportion of comparisons in which the measure of a single design point fails the comparison, if it truly
/// changes by `margins` margins. The other points do not change.
/// @param measure success_rate with a margin of 0.05, or arrival_time with a margin of a tenth of the
///        baseline
double failure_rate(bool paired, const std::string& measure, double margins, std::int64_t count,
                    int comparisons) {
  constexpr SyntheticPoint point{0.8, 0.03, 0.5};
  std::mt19937_64 random(71);
  comparison::GateRules rules;
  rules.measures = {measure};
  rules.margins["success_rate"] = {0.05, 0.0, false};
  rules.margins["arrival_time"] = {0.0, 0.1, false};
  SyntheticPoint changed = point;
  if (measure == "success_rate") changed.success -= margins * 0.05;
  if (measure == "arrival_time") changed.settling *= 1.0 + margins * 0.1;
  int failures = 0;
  for (int i = 0; i < comparisons; ++i) {
    const TrialChances before = draw_chances(random, count);
    const TrialChances after = paired ? redraw_some(random, before, 0.2) : draw_chances(random, count);
    comparison::PointComparison one;
    one.baseline_trials = one.current_trials = count;
    one.judgements = comparison::compare_measures(
        rules, "", {synthetic_trials(point, before), synthetic_trials(changed, after), paired});
    comparison::decide(comparison::judgements_of({&one, 1}), rules);
    failures += failed(one.judgements.front());
  }
  return static_cast<double>(failures) / comparisons;
}

// A true change within the margin fails in at most the stated 5 %, whatever its estimate, and one of twice
// the margin is found.
void expect_failures_beyond_the_margin_alone(bool paired, int comparisons) {
  const double allowed = 0.05 + 2.5 * std::sqrt(0.05 * 0.95 / comparisons);
  for (const char* const measure : {"success_rate", "arrival_time"}) {
    for (const double margins : {0.8, 1.0}) {
      const double rate = failure_rate(paired, measure, margins, 400, comparisons);
      ::testing::Test::RecordProperty(fmt::format("{} {}", measure, margins), std::to_string(rate));
      EXPECT_LE(rate, allowed) << measure << ", " << margins << " margins";
    }
    const double power = failure_rate(paired, measure, 2.0, 1500, comparisons / 2);
    ::testing::Test::RecordProperty(fmt::format("{} 2", measure), std::to_string(power));
    EXPECT_GE(power, 0.5) << measure;
  }
}

TEST_P(NullComparisons, FailAChangeOfTheMarginNoMoreOftenThanStated) {
  expect_failures_beyond_the_margin_alone(GetParam(), 100);
}

TEST_P(NullComparisons, AStudyThatIsMuchWorseFails) {
  std::mt19937_64 random(53);
  int seen = 0;
  for (int i = 0; i < 20; ++i) {
    seen += any(compare_once(
                    random, GetParam(), {},
                    [](SyntheticPoint point) {
                      return SyntheticPoint{point.success - 0.15, 1.5 * point.settling, point.jerks};
                    },
                    400),
                failed);
  }
  EXPECT_EQ(seen, 20);
}

TEST_P(NullComparisons, AnImprovementIsReportedAndNoFailure) {
  std::mt19937_64 random(59);
  const auto compared = compare_once(
      random, GetParam(), {},
      [](SyntheticPoint point) {
        return SyntheticPoint{std::min(1.0, point.success + 0.3), point.settling, 0.0};
      },
      1000);
  EXPECT_FALSE(any(compared, failed));
  EXPECT_EQ(compared[2].judgements[0].change, comparison::ChangeVerdict::better);
  EXPECT_EQ(compared[2].judgements[0].verdict, comparison::GateVerdict::passed);
}

// The second point alone changes, and only in its rates.
void expect_the_detectable_to_be_found(bool paired, int comparisons) {
  std::mt19937_64 random(67);
  constexpr std::int64_t count = 400;
  double detectable = 0.0;
  for (int i = 0; i < 20; ++i)
    detectable +=
        compare_once(random, paired, {}, unchanged, count)[1].judgements[0].detectable_change / 20.0;
  EXPECT_GT(detectable, 0.02);
  int found = 0;
  for (int i = 0; i < comparisons; ++i) {
    const auto compared = compare_once(
        random, paired, {},
        [&](SyntheticPoint point) {
          if (point.success == points[1].success) point.success -= detectable;
          return point;
        },
        count);
    found += failed(compared[1].judgements[0]);
  }
  ::testing::Test::RecordProperty("found", found);
  EXPECT_GE(found, comparisons * 0.7);
  EXPECT_LE(found, comparisons * 0.95);
}

TEST_P(NullComparisons, AChangeOfTheDetectableSizeIsFoundAsOftenAsStated) {
  expect_the_detectable_to_be_found(GetParam(), 60);
}

TEST_P(NullComparisons, DISABLED_ErrAsOftenAsStatedInMany) {
  expect_false_alarms_as_stated(GetParam(), 600);
  expect_hardly_any_at_the_defaults(GetParam(), 600);
  expect_a_change_of_the_margin_to_fail(GetParam(), 400);
  expect_the_detectable_to_be_found(GetParam(), 200);
  expect_failures_beyond_the_margin_alone(GetParam(), 500);
}

INSTANTIATE_TEST_SUITE_P(Layers, NullComparisons, ::testing::Bool(),
                         [](const auto& layer) { return layer.param ? "Paired" : "TwoSamples"; });

}  // namespace
}  // namespace zerocount::testing
