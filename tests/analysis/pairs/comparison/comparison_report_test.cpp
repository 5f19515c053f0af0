// The answer of a comparison, and its JUnit XML.
#include <nlohmann/json.hpp>

#include "analysis/pairs/comparison/comparison.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

comparison::ChangeVerdict change_behind(comparison::GateVerdict verdict) {
  switch (verdict) {
    case comparison::GateVerdict::regression:
      return comparison::ChangeVerdict::worse;
    case comparison::GateVerdict::changed:
      return comparison::ChangeVerdict::better;
    case comparison::GateVerdict::inconclusive:
      return comparison::ChangeVerdict::undecided;
    case comparison::GateVerdict::passed:
      return comparison::ChangeVerdict::equivalent;
    case comparison::GateVerdict::not_measured:
      break;
  }
  return comparison::ChangeVerdict::not_measured;
}

comparison::Judgement reported_measure(const std::string& name, comparison::GateVerdict verdict) {
  comparison::Judgement one;
  one.measure = name;
  one.unit.assign(1, name == "arrival_time" ? 's' : '1');
  one.verdict = verdict;
  one.change = change_behind(verdict);
  if (verdict == comparison::GateVerdict::not_measured) return one;
  one.baseline = 0.9;
  one.current = 0.85;
  one.effect = 0.05;
  one.bounds = {0.01, 0.09};
  one.margin = 0.02;
  one.p = one.adjusted_p = 1e-9;
  return one;
}

comparison::StudyComparison sample() {
  comparison::StudyComparison comparison;
  comparison.baseline.path = "old.h5";
  comparison.current.header.name = "gains & <more>";
  comparison.layer = comparison::ComparisonLayer::paired;
  comparison.layer_reason = "the builds differ";
  comparison.manifest_differences = {{"controller.ki", "1e-5", ""}};
  comparison::PointComparison point;
  point.label = "a | \"b\"";
  point.judgements = {reported_measure("success_rate", comparison::GateVerdict::regression),
                      reported_measure("arrival_time", comparison::GateVerdict::inconclusive),
                      reported_measure("jerk_count", comparison::GateVerdict::not_measured),
                      reported_measure("stable_rate", comparison::GateVerdict::passed)};
  point.judgements[1].trials_to_decide = 1234.0;
  point.judgements[1].decided_margin = 0.031;
  comparison::Judgement requirement;
  requirement.requirement = "success_rate ≥ 0.8";
  requirement.measure = "success_rate";
  requirement.unit = "1";
  requirement.verdict = comparison::GateVerdict::passed;
  point.judgements.push_back(requirement);
  comparison.points = {point};
  comparison.verdict = comparison::GateVerdict::regression;
  return comparison;
}

document::Answer answer_of(const comparison::StudyComparison& comparison) {
  return comparison::comparison_answer().of(comparison);
}

TEST(ComparisonReport, TheTableHoldsAllThatWasJudged) {
  const std::string table = document::text(answer_of(sample()));
  EXPECT_TRUE(says(table, "success_rate", "90 %", "85 %", "[1 %, 9 %]", "< 1e-4", "regression",
                   "1300 trials would decide", "these trials decide a margin above", "not measured",
                   "require success_rate", "controller.ki  1e-5      (absent)",
                   "regression: 1 of 4 judgements failed"));
}

TEST(ComparisonReport, ALongTableOmitsRowsThatPassed) {
  comparison::StudyComparison comparison = sample();
  comparison.points.assign(30, comparison.points[0]);
  const std::string table = document::text(answer_of(comparison));
  EXPECT_FALSE(says(table, "stable_rate"));
  EXPECT_TRUE(says(table, "(60 rows that simply passed are not shown)"));
}

TEST(ComparisonReport, AnswersAboutStabilityCountUndecidedMoves) {
  comparison::StudyComparison comparison = sample();
  const std::string remark = "undecided: 12 of 300 moves in the baseline, 4 of 280 in the file";
  EXPECT_FALSE(says(document::text(answer_of(comparison)), "undecided: "));
  comparison.points[0].baseline_undecided = {.moves = 300, .off_target = 12, .still_falling = 9};
  comparison.points[0].current_undecided = {.moves = 280, .off_target = 4, .still_falling = 0};
  comparison.points[0].judgements[3].verdict = comparison::GateVerdict::inconclusive;  // the stable rate
  comparison.notes = {"undecided in the file"};
  for (const std::string& text :
       {document::text(answer_of(comparison)), comparison::comparison_junit(comparison)}) {
    EXPECT_TRUE(says(text, remark));
    EXPECT_EQ(text.find(remark), text.rfind(remark)) << "beside the stable rate alone\n" << text;
  }
  EXPECT_TRUE(says(document::text(answer_of(comparison)), "undecided in the file"));
  const auto json = document::json(answer_of(comparison));
  EXPECT_EQ(json["points"][0]["baseline_undecided"]["still_falling"], 9);
  EXPECT_EQ(json["points"][0]["current_undecided"]["off_target"], 4);
}

// A change for the better that fails is a failure in every form, and is not called a regression.
TEST(ComparisonReport, AnImprovementThatFailsIsReportedAsAFailureButNotAsARegression) {
  comparison::StudyComparison comparison = sample();
  comparison.points[0].judgements = {reported_measure("success_rate", comparison::GateVerdict::changed)};
  comparison.verdict = comparison.points[0].verdict = comparison::GateVerdict::changed;
  const auto json = document::json(answer_of(comparison));
  EXPECT_EQ(json["verdict"], "changed");
  EXPECT_EQ(json["points"][0]["measures"][0]["verdict"], "better");
  EXPECT_EQ(json["points"][0]["measures"][0]["gate"], "changed");
  EXPECT_EQ(json["counts"]["better"], 1);
  EXPECT_TRUE(says(comparison::comparison_junit(comparison), "failures=\"1\""));
  const std::string text = document::text(answer_of(comparison));
  EXPECT_TRUE(text.starts_with("changed: 1 of 1 judgements failed (0 worse")) << text;
  EXPECT_FALSE(says(text, "regression"));
}

TEST(ComparisonReport, TheJsonReadsBack) {
  const auto json = document::json(answer_of(sample()));
  EXPECT_EQ(json["verdict"], "regression");
  EXPECT_EQ(json["layer"], "paired");
  EXPECT_EQ(json["counts"]["inconclusive"], 1);
  EXPECT_EQ(json["counts"]["worse"], 1);
  EXPECT_EQ(json["points"][0]["measures"][0]["effect_high"], 0.09);
  EXPECT_EQ(json["points"][0]["measures"][1]["trials_to_decide"], 1234);
  EXPECT_TRUE(json["points"][0]["measures"][2]["p"].is_null());
  EXPECT_EQ(json["points"][0]["requirements"][0]["require"], "success_rate ≥ 0.8");
}

TEST(ComparisonReport, JUnitCountsFailuresErrorsAndSkippedCases) {
  const TemporaryFolder folder;
  folder.write("r.xml", comparison::comparison_junit(sample()));
  const std::string command = fmt::format(
      "cd {} && {} -c 'import xml.etree.ElementTree as t; s=t.parse(\"r.xml\").getroot()[0]; "
      "print(s.get(\"name\"), len(s), s.get(\"tests\"), s.get(\"failures\"), len(s.findall(\"*/failure\")), "
      "s.get(\"errors\"), "
      "len(s.findall(\"*/error\")), len(s.findall(\"*/skipped\")), s[0].get(\"name\"))' > out 2>&1",
      folder.path().string(), ZEROCOUNT_PYTHON);
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(folder.read("out"), "gains & <more> 5 5 1 1 1 1 1 a | \"b\": success_rate\n");
}

// What no single case tells must be a case of its own, or a runner of tests would see all green.
TEST(ComparisonReport, JUnitReportsAnErrorIfNothingWasMeasured) {
  comparison::StudyComparison nothing;
  nothing.verdict = comparison::GateVerdict::inconclusive;
  EXPECT_TRUE(says(comparison::comparison_junit(nothing), "errors=\"1\""));
  comparison::StudyComparison unequal;
  unequal.layer = comparison::ComparisonLayer::bits;
  unequal.first_difference = "/outcome/creep: differs from row 3 on";
  unequal.verdict = comparison::GateVerdict::regression;
  EXPECT_TRUE(says(comparison::comparison_junit(unequal), "failures=\"1\""));
  EXPECT_TRUE(says(comparison::verdict_sentence(unequal), "/outcome/creep"));
  EXPECT_EQ(comparison::verdict_sentence(nothing), "inconclusive: nothing was measured");
}

// What no number of trials decides is named, with the margin that would be decided.
TEST(ComparisonReport, TheVerdictNamesTheNumberOfTrialsThatWouldDecide) {
  comparison::StudyComparison comparison = sample();
  comparison.verdict = comparison::GateVerdict::inconclusive;
  comparison.points[0].judgements.erase(comparison.points[0].judgements.begin());
  comparison.trials_to_decide = 5432.0;
  comparison.max_trials_to_decide = 9000.0;
  EXPECT_EQ(comparison::verdict_sentence(comparison),
            "inconclusive: 1 of 3 judgements are open; 5500 trials per design point would decide, with a "
            "probability of 80 %");
  comparison.trials_to_decide.reset();
  comparison.points[0].judgements[0].trials_to_decide.reset();
  comparison.points[0].judgements[0].max_trials_margin = 0.031;
  EXPECT_EQ(comparison::verdict_sentence(comparison),
            "inconclusive: 1 of 3 judgements are open; 9000 trials per design point would not decide: "
            "arrival_time at a | \"b\" (margin 0.02 s; 0.031 s would be decided)");
}

TEST(ComparisonReport, NumbersOfTrialsAreRoundedUp) {
  EXPECT_EQ(comparison::trials_text(7.0), "7");
  EXPECT_EQ(comparison::trials_text(1201.0), "1300");
  EXPECT_EQ(comparison::trials_text(1200.0), "1200");
  EXPECT_EQ(comparison::trials_text(999.0), "1000");
}

}  // namespace
}  // namespace zerocount::testing
