#include "analysis/trials/measures/move_event.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"

namespace zerocount::measures {
namespace {

constexpr double never = std::numeric_limits<double>::quiet_NaN();

study::Study study_with_goal() {
  return manifest::parse_study(R"(zerocount: 1
name: goal
seed: 1
trials: 10
friction: {k1: {uniform: [100, 120]}}
command: {targets: [10], hold: 0.5}
verdict: {bands: [2]}
goal: {band: 2, within: 0.1, moves: 0.9}
)",
                               "test.yaml");
}

trial::MoveOutcome move_with(double arrival_time) {
  trial::MoveOutcome move;
  move.outcome = trial::Outcome::zero_count;
  move.arrival_time = arrival_time;
  for (trial::BandOutcome& band : move.bands) band.settling_time = arrival_time;
  return move;
}

TEST(MoveEvent, AGoalIsMissedAfterItsTimeOrNeverReached) {
  const MoveEvent event = missed_criteria(study_with_goal());
  EXPECT_FALSE(happens(event, move_with(0.0999)));
  EXPECT_FALSE(happens(event, move_with(0.1)));
  EXPECT_TRUE(happens(event, move_with(0.1001)));
  EXPECT_TRUE(happens(event, move_with(never)));
}

TEST(MoveEvent, AMeasureIsComparedWithTheLimit) {
  const study::Study study = study_with_goal();
  for (const auto& [text, at_limit, above] :
       {std::tuple{"arrival_time > 0.2", false, true}, std::tuple{"arrival_time>=0.2", true, true},
        std::tuple{" arrival_time < 0.2 ", false, false}, std::tuple{"arrival_time ≤ 0.2", true, false}}) {
    const MoveEvent event = parse_event(study, text);
    EXPECT_EQ(happens(event, move_with(0.2)), at_limit) << text;
    EXPECT_EQ(happens(event, move_with(0.3)), above) << text;
    EXPECT_EQ(happens(event, move_with(0.1)), !above) << text;
    EXPECT_EQ(happens(event, move_with(never)), above) << text;  // later than any limit
  }
  EXPECT_TRUE(happens(parse_event(study, "band_settling_time[2] > 0.2"), move_with(0.3)));
}

// The score of the event grows towards the event, on both sides of a limit.
TEST(MoveEvent, TheScoreGrowsTowardsTheEvent) {
  const study::Study study = study_with_goal();
  const auto score = [&](const char* text, double time) {
    return score_of(MoveScore::event, parse_event(study, text), move_with(time));
  };
  EXPECT_LT(score("arrival_time > 0.2", 0.1), score("arrival_time > 0.2", 0.15));
  EXPECT_GT(score("arrival_time < 0.2", 0.25), score("arrival_time < 0.2", 0.3));
  EXPECT_LT(score_of(MoveScore::event, missed_criteria(study), move_with(0.05)),
            score_of(MoveScore::event, missed_criteria(study), move_with(0.09)));
}

TEST(MoveEvent, WrongTextsAreRefusedWithTheReason) {
  const study::Study study = study_with_goal();
  for (const auto& [text, expected] :
       {std::pair{"arrival_time", "compares nothing"}, std::pair{"arrival_time = 1", "compares nothing"},
        std::pair{"arrival_time > soon", "no number"},
        std::pair{"arival_time > 1", "did you mean 'arrival_time'?"},
        std::pair{"settling_time > 1", "may mean two measures, arrival_time"},
        std::pair{"band_settling_time[7] > 1", "names no measure"}}) {
    try {
      parse_event(study, text);
      ADD_FAILURE() << text;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(failure.what()).find(expected), std::string::npos) << failure.what();
    }
  }
}

}  // namespace
}  // namespace zerocount::measures
