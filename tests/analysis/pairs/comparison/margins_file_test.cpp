// The YAML file of margins and requirements, and what it says of mistakes.
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "tests/analysis/study_files.hpp"
#include "tests/support/marked_text.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

const std::vector<std::string> labels{"a", "b-with-kp"};

comparison::GateRules read(const std::string& text) {
  return comparison::parse_gate_rules(text, "gate.yaml", labels);
}

/// The message about the text, which may have marks «…» (see with_marks()).
std::string fault(const std::string& text) {
  const MarkedText marked = marked_text(text);
  return with_marks(refusal_by([&] { read(marked.text); }), "gate.yaml", marked);
}

TEST(MarginsFile, IsReadIntoTheGateRules) {
  const comparison::GateRules rules = read(R"(
confidence: 0.99
false_discovery_rate: 0.01
measures: [success_rate, arrival_time]
margins:
  success_rate: 0.005
  arrival_time: {relative: 0.1, absolute: 2.0e-3, fail_on: changed}
require: success_rate ≥ 0.9
points:
  b-with-kp:
    success_rate: 0.05
    require: [success_rate >= 0.5, arrival_time.p95 <= 0.2]
)");
  EXPECT_EQ(rules.confidence, 0.99);
  EXPECT_EQ(rules.false_discovery_rate, 0.01);
  const comparison::GateMeasure success = *comparison::find_gate_measure("success_rate");
  const comparison::GateMeasure settling = *comparison::find_gate_measure("arrival_time");
  EXPECT_EQ(comparison::margin_of(rules, "a", success).absolute, 0.005);
  EXPECT_EQ(comparison::margin_of(rules, "b-with-kp", success).absolute, 0.05);
  EXPECT_EQ(comparison::margin_of(rules, "b-with-kp", settling).relative, 0.1);
  EXPECT_TRUE(comparison::margin_of(rules, "a", settling).changed_fails);
  EXPECT_FALSE(rules.changed_fails);
  std::vector<std::string> judged;
  for (const comparison::GateMeasure& one :
       comparison::judged_measures(rules, layout::measure_table(), {{"", true}}))
    judged.emplace_back(one.name);
  EXPECT_EQ(judged, (std::vector<std::string>{"success_rate", "arrival_time"}));
  ASSERT_EQ(comparison::requirements_of(rules, "a").size(), 1u);
  ASSERT_EQ(comparison::requirements_of(rules, "b-with-kp").size(), 3u);
  EXPECT_EQ(comparison::requirements_of(rules, "b-with-kp")[2].limit.value, 0.2);
  EXPECT_EQ(comparison::requirements_of(rules, "b-with-kp")[2].limit.relation, text::Relation::at_most);
}

TEST(MarginsFile, FailOnChangedMakesEveryChangeFail) {
  EXPECT_TRUE(read("fail_on: changed\n").changed_fails);
  EXPECT_FALSE(read("fail_on: worse\n").changed_fails);
  EXPECT_EQ(fault("fail_on: «better»\n"),
            "gate.yaml:«»: fail_on: 'better' is not a kind of failure; expected worse or changed");
}

TEST(MarginsFile, UnnamedMeasuresKeepTheirDefaultMargins) {
  const comparison::GateRules rules = read("margins: {success_rate: 0.1}\n");
  const comparison::GateMeasure stable = *comparison::find_gate_measure("stable_rate");
  EXPECT_EQ(comparison::margin_of(rules, "a", stable).absolute, stable.margin.absolute);
  EXPECT_EQ(rules.confidence, comparison::GateRules{}.confidence);
  EXPECT_TRUE(rules.requirements.empty());
}

TEST(MarginsFile, EveryMistakeIsReportedWithLineAndColumn) {
  EXPECT_EQ(fault("margin: {}\n"),
            "gate.yaml:1:1: margin: unknown key, nearest known: margins; expected one of confidence, "
            "false_discovery_rate, fail_on, measures, margins, require, points");
  EXPECT_EQ(fault("margins: {«sucess_rate»: 0.1}\n"),
            "gate.yaml:«»: margins.sucess_rate: unknown key, nearest known: success_rate; expected one of "
            "goal_rate, goal_machines, goal_settling_time, success_rate, arrival_rate, stable_rate, "
            "arrival_time, jerk_count");
  EXPECT_EQ(
      fault("margins: {success_rate: «{}»}\n"),
      "gate.yaml:«»: margins.success_rate: the margin has no size; expected absolute or relative, or both");
  EXPECT_EQ(
      fault("margins: {success_rate: «2»}\n"),
      "gate.yaml:«»: margins.success_rate: no proportion of trials can be worse by so much; expected less "
      "than 1, such as 0.02 for two percent points");
  EXPECT_EQ(fault("points: {«c»: {success_rate: 0.1}}\n"),
            "gate.yaml:«»: points.c: no design point of the files has this label; expected one of theirs, "
            "such as "
            "'a'");
  EXPECT_EQ(fault("require: «success_rate = 1»\n"),
            "gate.yaml:«»: require: 'success_rate = 1' cannot be understood; expected a text such as "
            "'success_rate "
            "≥ 0.995' (or >=, ≤, <=), or goal");
  for (const char* text : {"goal 5", "success_rate ≥ 0.9 of", "success_rate ≥", "≥ 0.9", "Success ≥ 0.9"})
    EXPECT_TRUE(says(fault(fmt::format("require: {}\n", text)), "cannot be understood")) << text;
  EXPECT_EQ(fault("require: [«success_rate ≥ 99.5»]\n"),
            "gate.yaml:«»: require.0: 99.5 is not a proportion; expected a number from 0 to 1");
  EXPECT_EQ(fault("require: «arrival_time.p95 ≥ 0.1»\n"),
            "gate.yaml:«»: require: arrival_time.p95 cannot have a lower limit; expected ≤ and a limit");
  EXPECT_EQ(fault("measures: «[]»\n"),
            "gate.yaml:«»: measures: the list is empty; expected a list of some of goal_rate, "
            "goal_machines, goal_settling_time, success_rate, arrival_rate, stable_rate, arrival_time, "
            "jerk_count");
  const std::string all = fault("margins: {success_rate: «-1», jerk_count: «no»}\nconfidence: «2»\n");
  EXPECT_TRUE(says(all, "gate.yaml:«1»: margins.success_rate: ",
                   "gate.yaml:«2»: margins.jerk_count: 'no' is a truth value; ",
                   "gate.yaml:«3»: confidence: "));
  EXPECT_TRUE(
      says(fault("require: speed ≥ 1\n"), "'speed' cannot be required; expected one of success_rate"));
}

TEST(MarginsFile, RequirementsMayHaveAnyBlanks) {
  for (const std::string text :
       {"success_rate≥0.5", "'  success_rate  >=\t0.5 '", "\"\\tsuccess_rate >=0.5\\n\""}) {
    const comparison::GateRules rules = read("require: " + text + "\n");
    ASSERT_EQ(rules.requirements.size(), 1u) << text;
    EXPECT_EQ(rules.requirements[0].quantity.name, "success_rate");
    EXPECT_EQ(rules.requirements[0].limit.relation, text::Relation::at_least);
    EXPECT_EQ(rules.requirements[0].limit.value, 0.5);
  }
  EXPECT_EQ(read("require: arrival_time.p95<=0.1\n").requirements[0].limit.relation, text::Relation::at_most);
}

TEST(MarginsFile, RequirementsMayNameErrorBandsAndTheGoal) {
  const comparison::GateRules rules =
      read("require: ['band_settling_time[5].p95 ≤ 0.05', 'band_exits[0] <= 2', goal]\n");
  ASSERT_EQ(rules.requirements.size(), 3u);
  EXPECT_EQ(rules.requirements[0].quantity.measure.measure->band, 5);
  EXPECT_EQ(rules.requirements[0].quantity.kind, comparison::RequirementKind::quantile);
  EXPECT_EQ(rules.requirements[1].quantity.kind, comparison::RequirementKind::mean);
  EXPECT_EQ(rules.requirements[2].quantity.kind, comparison::RequirementKind::goal);
  EXPECT_TRUE(comparison::requires_goal(rules));
  EXPECT_EQ(comparison::measures_of_limits(rules).size(), 2u);
  EXPECT_TRUE(says(fault("require: goal ≥ 0.5\n"), "a goal with a limit; expected goal by itself"));
  for (const std::string name : {"band_settling_time[x]", "tolerance_settling_time[x]",
                                 "tolerance_settling_time[-1]", "tolerance_settling_time[inf]"})
    EXPECT_TRUE(says(fault("require: " + name + ".p95 ≤ 1\n"), "cannot be")) << name;
  for (const std::string tolerance : {"1e-8", "1.0e-08", "0.00000001"}) {
    const comparison::RequirableQuantity quantity =
        read("require: 'tolerance_settling_time[" + tolerance + "].p95 ≤ 0.05'\n").requirements[0].quantity;
    EXPECT_EQ(quantity.measure.measure->tolerance, 1e-8);
    EXPECT_EQ(quantity.name, "tolerance_settling_time[1e-08].p95");
  }
}

TEST(MarginsFile, AnIncompleteRequirementIsRefused) {
  for (const std::string text :
       {"success_rate", "success_rate ≥", "≥ 0.5", "success_rate 0.5", "success rate ≥ 0.5",
        "success_rate ≥ 0.5 s", "Success_rate ≥ 0.5", "success_rate > 0.5"}) {
    EXPECT_TRUE(says(fault("require: '" + text + "'\n"), "cannot be understood")) << text;
  }
  EXPECT_TRUE(says(fault("require: success_rate ≥<=0.5\n"), "'<=0.5' is not a number"));
  EXPECT_TRUE(says(fault("require: success_rate ≥ 0.5≤\n"), "'0.5≤' is not a number"));
}

TEST(MarginsFile, RefusesAVeryLongRequirement) {
  const std::string long_name = fault("require: «" + std::string(200'000, 'a') + " ≥ 1»\n");
  EXPECT_TRUE(
      says(long_name, "gate.yaml:«»: require: 'aaa", "' cannot be understood; expected a text such as"));
}

TEST(MarginsFile, AMissingOrEmptyFileIsRefused) {
  EXPECT_TRUE(says(fault(""), "the file is empty"));
  const TemporaryFolder folder;
  EXPECT_THROW(comparison::read_gate_rules(folder / "none.yaml", labels), Failure);
  EXPECT_EQ(comparison::read_gate_rules(folder.write("m.yaml", "confidence: 0.9\n"), labels).confidence, 0.9);
}

// Absolute requirements, judged by the bounds of one file.

comparison::PointTrials with_successes(std::int64_t successes, std::int64_t trials) {
  comparison::PointTrials all;
  all.trials = trials;
  all.moves = 1;
  for (std::int64_t i = 0; i < trials; ++i) {
    all.values["success_rate"].push_back(i < successes);
    all.values["arrival_rate"].push_back(i < successes);
    all.values["stable_rate"].push_back(i < successes);
    all.values["arrival_time"].push_back(i < successes ? 0.001 * static_cast<double>(i + 1) : std::nan(""));
    all.values["jerk_count"].push_back(static_cast<double>(i % 2));
  }
  return all;
}

comparison::Judgement judged(const std::string& text, const comparison::PointTrials& trials,
                             double failing = 0.95) {
  const comparison::GateRules rules = comparison::parse_gate_rules("require: '" + text + "'\n", "m.yaml", {});
  return comparison::judge_requirement(rules.requirements.front(), trials, 0.95, failing);
}

// 598 successes of 598 show 99.5 % with 95 % confidence, 597 of 597 do not: 0.995^598 < 0.05 < 0.995^597.
TEST(Requirement, PassesIfTheLowerBoundReachesTheLimit) {
  EXPECT_EQ(judged("success_rate ≥ 0.995", with_successes(598, 598)).verdict,
            comparison::GateVerdict::passed);
  const comparison::Judgement open = judged("success_rate >= 0.995", with_successes(597, 597));
  EXPECT_EQ(open.verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(open.current, 1.0);
}

TEST(Requirement, FailsIfTheUpperBoundIsBelowTheLimit) {
  EXPECT_EQ(judged("success_rate ≥ 0.995", with_successes(960, 1000)).verdict,
            comparison::GateVerdict::regression);
  EXPECT_EQ(judged("success_rate ≥ 0.995", with_successes(993, 1000)).verdict,
            comparison::GateVerdict::inconclusive);
  EXPECT_EQ(judged("success_rate ≤ 0.01", with_successes(0, 400)).verdict, comparison::GateVerdict::passed);
  EXPECT_EQ(judged("success_rate ≤ 0.01", with_successes(30, 400)).verdict,
            comparison::GateVerdict::regression);
}

TEST(Requirement, ManyOfThemMustBeContradictedMoreStrictly) {
  const comparison::PointTrials trials = with_successes(988, 1000);
  EXPECT_EQ(judged("success_rate ≥ 0.995", trials, 0.95).verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(judged("success_rate ≥ 0.995", trials, comparison::failing_confidence(0.95, 100)).verdict,
            comparison::GateVerdict::inconclusive);
  EXPECT_NEAR(comparison::failing_confidence(0.95, 100), 0.9995, 1e-15);
}

// A trial that does not arrive settles later than any limit.
TEST(Requirement, AQuantileCountsTrialsThatNeverSettle) {
  EXPECT_EQ(judged("arrival_time.p95 ≤ 0.5", with_successes(500, 500)).verdict,
            comparison::GateVerdict::passed);
  const comparison::Judgement late = judged("arrival_time.p95 ≤ 0.5", with_successes(400, 500));
  EXPECT_EQ(late.verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(late.current, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(judged("arrival_time.median ≤ 0.3", with_successes(400, 500)).current, 0.250, 1e-12);
}

TEST(Requirement, JerkCountIsJudgedByTheBoundsOfItsMean) {
  EXPECT_EQ(judged("jerk_count ≤ 0.7", with_successes(500, 500)).verdict, comparison::GateVerdict::passed);
  EXPECT_EQ(judged("jerk_count ≤ 0.4", with_successes(500, 500)).verdict,
            comparison::GateVerdict::regression);
  EXPECT_EQ(judged("jerk_count ≤ 0.51", with_successes(500, 500)).verdict,
            comparison::GateVerdict::inconclusive);
}

// At the limit itself a requirement is met: it must not fail more often than stated, nor pass.
TEST(Requirement, ATrueRateEqualToTheLimitRarelyFailsAndRarelyPasses) {
  std::mt19937_64 random(17);
  std::binomial_distribution<std::int64_t> law(500, 0.97);
  int passed = 0;
  int failed = 0;
  constexpr int rounds = 1000;
  for (int i = 0; i < rounds; ++i) {
    const comparison::GateVerdict verdict =
        judged("success_rate ≥ 0.97", with_successes(law(random), 500)).verdict;
    passed += verdict == comparison::GateVerdict::passed;
    failed += verdict == comparison::GateVerdict::regression;
  }
  EXPECT_LE(passed, 0.05 * rounds);
  EXPECT_LE(failed, 0.05 * rounds);
}

// Making and replacing a baseline, with the reason on record.

class Baselines : public ::testing::Test {
 protected:
  std::filesystem::path results(const std::string& name, std::int64_t first) {
    std::vector<TrialRecord> records;
    for (std::int64_t row = 0; row < 60; ++row) records.push_back(random_trial(first + row, 1));
    write_study_file(folder_ / name, plain_study(2, 30, 1), records);
    return folder_ / name;
  }

  TemporaryFolder folder_;
};

TEST_F(Baselines, AreByteIdenticalCopiesOfTheResultsFile) {
  const comparison::BaselineUpdate update =
      comparison::update_baseline(results("a.h5", 0), folder_ / "base.h5", "the first: \"it works\"");
  EXPECT_TRUE(update.changed);
  EXPECT_EQ(update.comparison, "");
  EXPECT_EQ(folder_.read("base.h5"), folder_.read("a.h5"));
  const std::string log = folder_.read("base.h5.log.yaml");
  EXPECT_TRUE(says(log, "  reason: \"the first: \\\"it works\\\"\"\n"));
  EXPECT_FALSE(says(log, "replaces"));
}

TEST_F(Baselines, KeepALogOfTheFilesTheyReplace) {
  comparison::update_baseline(results("a.h5", 0), folder_ / "base.h5", "first");
  const std::string before = folder_.read("base.h5.log.yaml");
  const comparison::BaselineUpdate update =
      comparison::update_baseline(results("b.h5", 1000), folder_ / "base.h5", "second");
  EXPECT_NE(update.comparison, "");
  EXPECT_EQ(folder_.read("base.h5"), folder_.read("b.h5"));
  const std::string log = folder_.read("base.h5.log.yaml");
  EXPECT_TRUE(log.starts_with(before));
  EXPECT_TRUE(says(log, "  replaces: \"", "  comparison: \"" + update.comparison.substr(0, 8)));
}

TEST_F(Baselines, AreNotReplacedByTheSameFile) {
  const auto file = results("a.h5", 0);
  comparison::update_baseline(file, folder_ / "base.h5", "first");
  const std::string log = folder_.read("base.h5.log.yaml");
  EXPECT_FALSE(comparison::update_baseline(file, folder_ / "base.h5", "again").changed);
  EXPECT_EQ(folder_.read("base.h5.log.yaml"), log);
}

TEST_F(Baselines, AChangeWithoutALogEntryGivesAWarning) {
  comparison::update_baseline(results("a.h5", 0), folder_ / "base.h5", "first");
  std::filesystem::copy_file(results("b.h5", 1000), folder_ / "base.h5",
                             std::filesystem::copy_options::overwrite_existing);
  const comparison::BaselineUpdate update =
      comparison::update_baseline(results("c.h5", 2000), folder_ / "base.h5", "third");
  ASSERT_FALSE(update.warnings.empty());
  EXPECT_TRUE(says(update.warnings[0], "without a record"));
}

TEST_F(Baselines, AreNeverMadeOfADamagedFile) {
  const auto file = results("a.h5", 0);
  std::string bytes = read_bytes(file);
  bytes[bytes.size() / 2] ^= 1;
  write_bytes(file, bytes);
  EXPECT_THROW(comparison::update_baseline(file, folder_ / "base.h5", "first"), Failure);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "base.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "base.h5.log.yaml"));
}

}  // namespace
}  // namespace zerocount::testing
