// The sentences of an answer of `tune`, with numbers that are infinite, missing or not reached.
#include "runners/design_commands/tune_answer.hpp"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "experiments/manifest/load_study.hpp"

namespace zerocount::design_commands {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using tuning::NearestPoint;
using tuning::Proof;
using tuning::SmallestMargins;
using tuning::TuneAnswer;

constexpr double never = std::numeric_limits<double>::infinity();

study::Study axis() {
  return manifest::parse_study(R"(zerocount: 1
name: axis
seed: 1
trials: 10
command: {targets: [9], hold: 0.1}
controller: {ki: 2.0e-5}
goal: {band: 1, within: 0.05, moves: 0.9}
tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}, controller.kp: [0, 1.0e-3]}, margins: {delay: off}}
)",
                               "axis.yaml");
}

TuneAnswer answer_for(const study::Study& study, goal::Status status) {
  TuneAnswer answer;
  answer.status = status;
  answer.free = study.tuning->free;
  answer.gains = {2e-5, 0.0};
  answer.proof = Proof{study, {}, {}, 1};
  answer.proof->verdict.moves = {0.853, 0.82, 0.88};
  answer.criterion = never;
  answer.late_limit = never;
  return answer;
}

std::string text_of(const TuneAnswer& answer, const study::Study& study) {
  return document::text(tune_answer().of({answer, study, "tuned.h5"}));
}

nlohmann::ordered_json json_of(const TuneAnswer& answer, const study::Study& study) {
  return document::json(tune_answer().of({answer, study, "tuned.h5"}));
}

TEST(TuneAnswer, SaysThatATimeIsNotReachedInASentence) {
  const study::Study study = axis();
  const std::string text = text_of(answer_for(study, goal::Status::missed), study);
  EXPECT_THAT(text, HasSubstr("band_settling_time.p95 by the proof: not within the hold\n"));
  EXPECT_THAT(
      text, HasSubstr("fewer than 90 % of the moves are within the band for good at the end of the hold\n"));
  for (const char* const hole : {"hold s", "inf", "nan", "–"}) EXPECT_THAT(text, Not(HasSubstr(hole)));
}

TEST(TuneAnswer, UnreachableSaysByHowMuchTheGoalIsMissed) {
  const study::Study study = axis();
  EXPECT_EQ(json_of(answer_for(study, goal::Status::missed), study)["headline"],
            "unreachable in these ranges: at the best values found 85.3 % of the moves meet the goal, and at "
            "least 90 % are wanted");
}

TEST(TuneAnswer, NamesEachMarginWithItsUnitAndWhatIsWanted) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.margins = SmallestMargins{true, never, 41.0, 10.0, 8};
  EXPECT_THAT(
      text_of(answer, study),
      HasSubstr(
          "smallest margins of 8 machines before they slide: gain margin ∞ dB (at least 6 wanted), "
          "phase margin 41 degrees (at least 30 wanted), delay margin 10 samples or more (none wanted)\n"));
}

TEST(TuneAnswer, NamesTheMarginsThatTheNearestPointLacks) {
  const study::Study study = axis();
  TuneAnswer answer;
  answer.status = goal::Status::missed;
  answer.free = study.tuning->free;
  answer.examined = 4000;
  answer.nearest = NearestPoint{{3e-5, 1e-4}, {true, 4.5, 41.0, 2.0, 8}};
  const std::string text = text_of(answer, study);
  EXPECT_THAT(text, HasSubstr("none of 4000 points that were tried keeps the margins\n"));
  EXPECT_THAT(text,
              HasSubstr("nearest: controller.ki = 3e-05, controller.kp = 0.0001, with gain margin 4.5 dB"));
  EXPECT_THAT(text, HasSubstr("  its gain margin is 1.5 dB too small\n"));
  EXPECT_THAT(text, Not(HasSubstr("its phase margin")));
  const nlohmann::ordered_json json = json_of(answer, study);
  EXPECT_EQ(json["nearest"]["lacking"], (nlohmann::ordered_json{{"gain", 1.5}}));
  answer.nearest->margins.stable = false;
  EXPECT_THAT(text_of(answer, study), HasSubstr("unstable at all of them; nearest, at"));
}

TEST(TuneAnswer, NamesWhatTheBudgetWasNotEnoughFor) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.budget.trials = 900;
  answer.spent_trials = 880;
  answer.left_out = {"room", "limits"};
  const std::string text = text_of(answer, study);
  EXPECT_THAT(text, HasSubstr("spent: 880 of 900 trials"));
  EXPECT_THAT(text, HasSubstr("the budget is not enough: room; limits\n"));
  EXPECT_EQ(json_of(answer, study)["left_out"], (nlohmann::ordered_json{"room", "limits"}));
}

/// A verdict on each of two goals under each of two conditions: the second goal is the worst, under the
/// second.
goal::Verdict verdict_on_claims() {
  goal::Verdict whole;
  for (std::size_t goal = 0; goal < 2; ++goal) {
    goal::Verdict of_goal;
    for (std::size_t condition = 0; condition < 2; ++condition) {
      goal::Verdict& one = of_goal.conditions.emplace_back();
      one.status = goal::Status::met;
      one.moves.value = 0.99 - 0.02 * static_cast<double>(goal) - 0.01 * static_cast<double>(condition);
    }
    of_goal.moves = of_goal.conditions[1].moves;
    of_goal.condition = 1;
    whole.goals.push_back(of_goal);
  }
  whole.status = goal::Status::met;
  whole.moves = whole.goals[1].moves;
  whole.goal = 1;
  whole.condition = 1;
  return whole;
}

TEST(TuneAnswer, NamesTheGoalAndTheConditionThatAreMetByTheLeast) {
  const study::Study study = manifest::parse_study(R"(zerocount: 1
name: axis
seed: 1
trials: 10
command: {targets: [9, 0], hold: 0.1}
conditions: {empty: {}, loaded: {plant.inertia: 8.0e-4}}
controller: {ki: 2.0e-5}
goals: {large: {on: [0], band: 1, within: 0.05, moves: 0.9}, small: {on: [1], band: 1, within: 0.02, moves: 0.9}}
tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}, controller.kp: [0, 1.0e-3]}}
)",
                                                   "axis.yaml");
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.proof->verdict = verdict_on_claims();
  answer.criterion = 0.7;
  answer.delay_sought = true;
  answer.delay_lost = tuning::DelayLost{1.5, 0};
  answer.delay = 1.0;
  answer.room = {{"controller.ki", 1e-5, 2e-5, std::nullopt, 3}};
  const nlohmann::ordered_json json = json_of(answer, study);
  EXPECT_EQ(json["headline"],
            "met: all 2 goals are met by these values under each of 2 conditions, 'small' under condition "
            "loaded by the least");
  ASSERT_EQ(json["claims"].size(), 4U);
  EXPECT_EQ(json["claims"][1]["goal"], "large");
  EXPECT_EQ(json["claims"][1]["condition"], "loaded");
  EXPECT_EQ(json["claims"][2]["rate"], 0.97);
  EXPECT_EQ(json["proof"]["goal"], "small");
  EXPECT_EQ(json["proof"]["condition"], "loaded");
  EXPECT_EQ(json["proof"]["rate"], 0.96);
  const std::string text = text_of(answer, study);
  EXPECT_THAT(text, HasSubstr("the worst of goal 'small' under condition loaded: 96 % of its moves meet it"));
  EXPECT_THAT(text,
              HasSubstr("the largest of all goals and conditions: 0.7 of the time that its goal allows\n"));
  EXPECT_THAT(text, HasSubstr("with 0.5 samples more of controller.delay the goal 'large' seems lost, first "
                              "under condition empty\n"));
  EXPECT_THAT(text,
              HasSubstr("controller.ki above its room: the goal 'small' is lost under condition loaded\n"));
  const study::Study alone = axis();
  EXPECT_FALSE(json_of(answer_for(alone, goal::Status::met), alone).contains("claims"));
}

// What is printed as soon as it is proven, and the rest, are the whole.
TEST(TuneAnswer, IsTheProvenPartAndTheRest) {
  const study::Study study = axis();
  const TuneAnswer answer = answer_for(study, goal::Status::met);
  const Tuning tuning{answer, study, "tuned.h5"};
  EXPECT_EQ(document::text(proven_answer().of(tuning)) + document::text(rest_answer().of(tuning)),
            document::text(tune_answer().of(tuning)));
  EXPECT_THAT(document::text(proven_answer().of(tuning)), HasSubstr("wrote tuned.h5"));
}

}  // namespace
}  // namespace zerocount::design_commands
