// The sentences of an answer of `tune`, with numbers that are infinite, missing or not reached.
#include "runners/tuning/tune_text.hpp"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "experiments/manifest/load_study.hpp"

namespace zerocount::tuning {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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

TEST(TuneText, SaysThatATimeIsNotReachedInASentence) {
  const study::Study study = axis();
  const std::string text = proven_text(answer_for(study, goal::Status::missed), study, "tuned.h5");
  EXPECT_THAT(text, HasSubstr("band_settling_time.p95 by the proof: not within the hold\n"));
  EXPECT_THAT(
      text, HasSubstr("fewer than 90 % of the moves are within the band for good at the end of the hold\n"));
  for (const char* const hole : {"hold s", "inf", "nan", "–"}) EXPECT_THAT(text, Not(HasSubstr(hole)));
}

TEST(TuneText, UnreachableSaysByHowMuchTheGoalIsMissed) {
  const study::Study study = axis();
  EXPECT_EQ(headline(answer_for(study, goal::Status::missed), study),
            "unreachable in these ranges: at the best values found 85.3 % of the moves meet the goal, and at "
            "least 90 % are wanted");
}

TEST(TuneText, NamesEachMarginWithItsUnitAndWhatIsWanted) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.margins = SmallestMargins{true, never, 41.0, 10.0, 8};
  EXPECT_THAT(
      rest_text(answer, study),
      HasSubstr("smallest margins of 8 machines before they slide: gain margin ∞ dB (at least 6 wanted), "
                "phase margin 41° (at least 30 wanted), delay margin 10 samples or more (none wanted)\n"));
}

TEST(TuneText, NamesTheMarginsThatTheNearestPointLacks) {
  const study::Study study = axis();
  TuneAnswer answer;
  answer.status = goal::Status::missed;
  answer.free = study.tuning->free;
  answer.examined = 4000;
  answer.nearest = NearestPoint{{3e-5, 1e-4}, {true, 4.5, 41.0, 2.0, 8}};
  const std::string text = proven_text(answer, study, "tuned.h5");
  EXPECT_THAT(text, HasSubstr("none of 4000 points that were tried keeps the margins\n"));
  EXPECT_THAT(text,
              HasSubstr("nearest: controller.ki = 3e-05, controller.kp = 0.0001, with gain margin 4.5 dB"));
  EXPECT_THAT(text, HasSubstr("  its gain margin is 1.5 dB too small\n"));
  EXPECT_THAT(text, Not(HasSubstr("its phase margin")));
  const nlohmann::json json = nlohmann::json::parse(json_of(answer, study));
  EXPECT_EQ(json["nearest"]["lacking"], (nlohmann::json{{"gain", 1.5}}));
  answer.nearest->margins.stable = false;
  EXPECT_THAT(proven_text(answer, study, "tuned.h5"), HasSubstr("unstable at all of them; nearest, at"));
}

TEST(TuneText, NamesWhatTheBudgetWasNotEnoughFor) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.budget.trials = 900;
  answer.spent_trials = 880;
  answer.left_out = {"room", "limits"};
  const std::string text = rest_text(answer, study);
  EXPECT_THAT(text, HasSubstr("spent: 880 of 900 trials"));
  EXPECT_THAT(text, HasSubstr("the budget is not enough: room; limits\n"));
  EXPECT_EQ(nlohmann::json::parse(json_of(answer, study))["left_out"], (nlohmann::json{"room", "limits"}));
}

}  // namespace
}  // namespace zerocount::tuning
