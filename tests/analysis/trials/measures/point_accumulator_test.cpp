#include "analysis/trials/measures/point_accumulator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "core/trial/divergence.hpp"

namespace zerocount::measures {
namespace {

trial::MoveOutcome move_that(trial::Outcome outcome, double arrival_time) {
  trial::MoveOutcome move;
  move.outcome = outcome;
  move.arrived = std::isfinite(arrival_time);
  move.stable = move.arrived && outcome <= trial::Outcome::one_count;
  move.arrival_time = arrival_time;
  return move;
}

constexpr double never = std::numeric_limits<double>::quiet_NaN();

/// Adds to the statistics a trial of one move that arrives at 0.1 s, holds with `torque`, and has jerks of
/// one count in the direction +1 at the times `onsets` (s).
void add_jerking(PointAccumulator& point, double torque, const std::vector<double>& onsets) {
  trial::MoveOutcome move = move_that(trial::Outcome::zero_count, 0.1);
  move.holding_torque = torque;
  move.jerk_count = static_cast<std::int64_t>(onsets.size());
  std::vector<trial::Jerk> jerks;
  for (const double onset : onsets) jerks.push_back({0, onset, 0.001, 1, 1});
  point.add({{move}}, jerks);
}

TEST(PointStatistics, WithoutTrialsEverythingIsUndefined) {
  const PointSummary none = PointAccumulator().statistics();
  EXPECT_EQ(none.trials, 0);
  EXPECT_TRUE(std::isnan(none.success_rate().value));
  EXPECT_TRUE(std::isnan(none.success_rate().clopper_pearson.low));
  EXPECT_TRUE(std::isnan(none.success_rate().clopper_pearson.high));
  EXPECT_TRUE(std::isnan(none.of(&trial::MoveOutcome::final_error).mean));
  EXPECT_TRUE(std::isnan(none.of(&trial::MoveOutcome::arrival_time).median.value));
  EXPECT_TRUE(std::isnan(none.of(&trial::MoveOutcome::jerk_count).mean));
  EXPECT_TRUE(std::isnan(none.jerk_agreement));
}

TEST(PointStatistics, EachTrialCountsOnceWithItsWorstMove) {
  PointAccumulator point;
  point.add({{move_that(trial::Outcome::zero_count, 0.1), move_that(trial::Outcome::zero_count, 0.2)}}, {});
  point.add({{move_that(trial::Outcome::one_count, 0.1), move_that(trial::Outcome::zero_count, 0.2)}}, {});
  point.add({{move_that(trial::Outcome::oscillating, never), move_that(trial::Outcome::one_count, 0.3)}}, {});
  point.add({{move_that(trial::Outcome::oscillating, never), move_that(trial::Outcome::nonfinite, never)}},
            {});
  const PointSummary statistics = point.statistics();

  EXPECT_EQ(statistics.trials, 4);
  EXPECT_EQ(statistics.moves, 8);
  EXPECT_EQ(statistics.outcomes.zero_count, 1);
  EXPECT_EQ(statistics.outcomes.one_count, 1);
  EXPECT_EQ(statistics.outcomes.oscillating, 1);
  EXPECT_EQ(statistics.outcomes.nonfinite, 1);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::stable).trials, 2);   // all moves stable
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::arrived).trials, 2);  // all moves arrived
  EXPECT_EQ(statistics.success_rate().value, 0.25);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::stable).rate.value, 0.5);
  EXPECT_EQ(statistics.success_rate().clopper_pearson.high, statistics::clopper_pearson(1, 4).high);
  EXPECT_EQ(statistics.success_rate().wilson.low, statistics::wilson(1, 4).low);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::stable).rate.clopper_pearson.low,
            statistics::clopper_pearson(2, 4).low);

  ASSERT_EQ(statistics.by_move.size(), 2U);
  EXPECT_EQ(statistics.by_move[0].oscillating, 2);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::arrived).by_move[0], 2);
  EXPECT_EQ(statistics.by_move[1].zero_count, 2);
  EXPECT_EQ(statistics.by_move[1].nonfinite, 1);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::stable).by_move[1], 3);
}

TEST(PointStatistics, BreakawayAndSaturationInAnyMoveCountTheTrialOnce) {
  trial::MoveOutcome plain = move_that(trial::Outcome::zero_count, 0.1), marked = plain;
  marked.broke_away = marked.saturated = true;
  PointAccumulator point;
  point.add({{plain, plain}}, {});
  point.add({{plain, marked}}, {});
  point.add({{marked, marked}}, {});
  const PointSummary statistics = point.statistics();
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::broke_away).trials, 2);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::saturated).trials, 2);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::broke_away).by_move[0], 1);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::saturated).by_move[1], 2);
}

TEST(PointStatistics, StoppedTrialsCountInEveryRate) {
  trial::MoveOutcome sound = move_that(trial::Outcome::zero_count, 0.1),
                     stopped = move_that(trial::Outcome::oscillating, never);
  sound.holding_torque = 0.01;
  sound.overshoot = 4;
  stopped.holding_torque = 0.03;
  stopped.overshoot = 1500;
  stopped.final_error = -1500;
  stopped.stopped = true;
  PointAccumulator point;
  point.add({{sound, sound, sound}}, {});
  point.add({{sound, stopped, trial::move_not_run()}}, {});
  point.add({{stopped, trial::move_not_run(), trial::move_not_run()}}, {});
  const PointSummary statistics = point.statistics();
  EXPECT_EQ(statistics.trials, 3);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::stopped).trials, 2);
  EXPECT_EQ(statistics.outcomes.zero_count, 1);
  EXPECT_EQ(statistics.outcomes.oscillating, 2);
  EXPECT_EQ(statistics.success_rate().value, 1.0 / 3.0);
  ASSERT_EQ(statistics.by_move.size(), 3U);
  for (int move = 0; move < 3; ++move) {
    EXPECT_EQ(statistics.of(&trial::MoveOutcome::stopped).by_move[static_cast<std::size_t>(move)],
              std::min(move + 1, 2));
    EXPECT_EQ(statistics.by_move[static_cast<std::size_t>(move)].oscillating, std::min(move + 1, 2));
  }
  EXPECT_EQ(statistics.moves, 9);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::overshoot).n, 6);  // three were not run
  for (double trial::MoveOutcome::*measure :
       {&trial::MoveOutcome::holding_torque, &trial::MoveOutcome::peak_torque, &trial::MoveOutcome::creep,
        &trial::MoveOutcome::travel_time}) {
    EXPECT_EQ(statistics.of(measure).n, 6);
    EXPECT_EQ(statistics.of(measure).nonfinite, 0);
  }
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::final_error).n, 6);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::final_error).max, 1500.0);
  EXPECT_NEAR(statistics.of(&trial::MoveOutcome::overshoot).mean, (4 * 4 + 2 * 1500) / 6.0, 1e-9);
  EXPECT_NEAR(statistics.of(&trial::MoveOutcome::holding_torque).mean, (4 * 0.01 + 2 * 0.03) / 6.0, 1e-15);
}

TEST(PointStatistics, QuantilesOfFinalSettlingTimesIncludeMovesThatNeverSettled) {
  PointAccumulator point;
  for (int i = 1; i <= 100; ++i) {
    trial::MoveOutcome move =
        move_that(i <= 60 ? trial::Outcome::zero_count : trial::Outcome::one_count, 0.01);
    if (i <= 60) move.final_settling_time = i / 2000.0;
    point.add({{move}}, {});
  }
  const MeasureStatistics final = point.statistics().of(&trial::MoveOutcome::final_settling_time);
  EXPECT_EQ(final.n, 60);
  EXPECT_EQ(final.moves, 100);
  EXPECT_EQ(final.median.value, 50 / 2000.0);
  EXPECT_TRUE(std::isnan(final.p75.value));
  EXPECT_NEAR(final.mean, 30.5 / 2000.0, 1e-15);
}

TEST(PointStatistics, ToleranceLimitsUseTheSlowestMoveOfATrial) {
  PointAccumulator on_machines({.shape = {.machines = 100}}), plain;
  for (int trial = 0; trial < 100; ++trial) {
    const trial::TrialOutcome moves{
        {move_that(trial::Outcome::zero_count, 0.5), move_that(trial::Outcome::zero_count, 0.01)}};
    on_machines.add(moves, {});
    plain.add(moves, {});
  }
  EXPECT_EQ(plain.statistics().settles_within[0].within, 0.5);
  EXPECT_EQ(on_machines.statistics().settles_within[0].within, 0.5);
}

TEST(PointStatistics, QuantilesOfArrivalTimesIncludeMovesThatNeverArrivedAndMeansDoNot) {
  PointAccumulator point;
  for (int i = 1; i <= 100; ++i) point.add({{move_that(trial::Outcome::zero_count, i / 2000.0)}}, {});
  for (int i = 0; i < 50; ++i) point.add({{move_that(trial::Outcome::oscillating, never)}}, {});
  const PointSummary statistics = point.statistics();
  const MeasureStatistics& settling = statistics.of(&trial::MoveOutcome::arrival_time);
  EXPECT_EQ(statistics.trials, 150);
  EXPECT_EQ(settling.n, 100);
  EXPECT_NEAR(settling.mean, 50.5 / 2000.0, 1e-15);
  EXPECT_EQ(settling.min, 1 / 2000.0);
  EXPECT_EQ(settling.moves, 150);
  EXPECT_EQ(settling.p05.value, 8 / 2000.0);
  EXPECT_EQ(settling.p25.value, 38 / 2000.0);
  EXPECT_EQ(settling.median.value, 75 / 2000.0);
  EXPECT_EQ(settling.median.low, 63 / 2000.0);  // ranks of the binomial (150, 1/2)
  EXPECT_EQ(settling.median.high, 88 / 2000.0);
  EXPECT_TRUE(std::isnan(settling.p75.value));  // among the third that never arrived
  EXPECT_TRUE(std::isnan(settling.p75.high));
  EXPECT_TRUE(std::isnan(settling.p95.value));
  EXPECT_EQ(settling.max, 100 / 2000.0);
}

TEST(PointStatistics, TrialsWithoutJerksCountInTheJerksPerTrial) {
  PointAccumulator point;
  add_jerking(point, 0.1, {});
  add_jerking(point, 0.1, {0.2});
  add_jerking(point, 0.1, {0.2, 0.4, 0.7, 1.2, 2.0});
  point.add({{move_that(trial::Outcome::oscillating, never)}}, {});
  const MeasureStatistics jerks = point.statistics().of(&trial::MoveOutcome::jerk_count);
  EXPECT_EQ(jerks.n, 4);
  EXPECT_EQ(jerks.total, 6);
  EXPECT_EQ(jerks.mean, 1.5);
  EXPECT_NEAR(jerks.sd, std::sqrt((2.25 + 0.25 + 12.25 + 2.25) / 3.0), 1e-15);
  EXPECT_EQ(jerks.median.value, 0.0);
  EXPECT_EQ(jerks.p95.value, 5.0);
  EXPECT_EQ(jerks.max, 5.0);
}

TEST(PointStatistics, IntervalsLieBetweenOnsetsOfTheSameMove) {
  trial::MoveOutcome first = move_that(trial::Outcome::zero_count, 0.1), second = first;
  first.jerk_count = 2;
  second.jerk_count = 3;
  PointAccumulator point;
  point.add({{first, second}}, std::vector<trial::Jerk>{{0, 0.5, 0.01, 1, 1},
                                                        {0, 0.8, 0.01, 1, 1},
                                                        {1, 0.2, 0.01, 1, 1},
                                                        {1, 0.3, 0.01, 1, 1},
                                                        {1, 0.5, 0.01, 1, 1}});
  const JerkIntervalStatistics intervals = point.statistics().jerk_interval;
  EXPECT_EQ(intervals.n, 3);
  EXPECT_NEAR(intervals.mean, 0.2, 1e-15);
  EXPECT_EQ(intervals.median, 0.2);
}

TEST(PointStatistics, SlowingDownIsJudgedPerMoveByTheTrendOfItsIntervals) {
  PointAccumulator point;
  add_jerking(point, 0.1, {0.2, 0.3, 0.5, 0.9});       // 0.1, 0.2, 0.4: slowing, 3 rising pairs
  add_jerking(point, 0.1, {0.2, 0.6, 0.8, 1.5});       // 0.4, 0.2, 0.7: slowing, 2 rising, 1 falling
  add_jerking(point, 0.1, {0.2, 0.6, 0.8});            // 0.4, 0.2: quickening, 1 falling
  add_jerking(point, 0.1, {0.1, 0.2, 0.3, 0.4, 0.5});  // all 0.1 in spite of rounding: neither, 6 equal
  add_jerking(point, 0.1, {0.2, 0.3});                 // one interval: not judged
  const JerkSlowing slowing = point.statistics().jerk_slowing;
  EXPECT_EQ(slowing.moves, 4);
  EXPECT_EQ(slowing.slowing, 2);
  EXPECT_EQ(slowing.quickening, 1);
  EXPECT_EQ(slowing.proportion, 0.5);
  EXPECT_NEAR(slowing.tau, (5.0 - 2.0) / 13.0, 1e-15);
}

TEST(PointStatistics, JerkAgreementAndMagnitudeAreProportionsOfAllJerks) {
  trial::MoveOutcome up = move_that(trial::Outcome::zero_count, 0.1), down = up, none = up;
  up.holding_torque = 0.02;
  down.holding_torque = -0.02;
  none.holding_torque = 0.0;
  up.jerk_count = 3;
  down.jerk_count = none.jerk_count = 1;
  PointAccumulator point;
  point.add({{up}},
            std::vector<trial::Jerk>{{0, 0.2, 0.01, 1, 1}, {0, 0.3, 0.01, 2, 1}, {0, 0.4, 0.01, 1, -1}});
  point.add({{down}}, std::vector<trial::Jerk>{{0, 0.2, 0.01, 1, -1}});
  point.add({{none}}, std::vector<trial::Jerk>{{0, 0.2, 0.01, 1, 1}});  // agrees with no direction
  const PointSummary statistics = point.statistics();
  EXPECT_EQ(statistics.jerks_agreeing, 3);
  EXPECT_NEAR(statistics.jerk_agreement, 3.0 / 5.0, 1e-15);
  EXPECT_NEAR(statistics.jerk_one_count_share, 4.0 / 5.0, 1e-15);
}

TEST(PointStatistics, MeansCountTheirFiniteValues) {
  PointAccumulator point;
  trial::MoveOutcome move = move_that(trial::Outcome::zero_count, 0.1);
  move.overshoot = 2;
  move.holding_torque = 0.03;
  move.creep = 1e-7;
  move.peak_torque = 0.05;
  move.reversal_depth = 7;
  point.add({{move}}, {});
  move.overshoot = 0;
  move.holding_torque = -0.01;
  move.creep = -3e-7;
  move.reversal_depth = 3;
  point.add({{move}}, {});
  trial::MoveOutcome lost = move_that(trial::Outcome::nonfinite, never);
  lost.holding_torque = lost.creep = never;
  point.add({{lost}}, {});
  const PointSummary statistics = point.statistics();
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::holding_torque).n, 2);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::holding_torque).nonfinite, 1);
  EXPECT_NEAR(statistics.of(&trial::MoveOutcome::holding_torque).mean, 0.01, 1e-16);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::holding_torque).min, -0.01);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::holding_torque).max, 0.03);
  EXPECT_NEAR(statistics.of(&trial::MoveOutcome::creep).mean, -1e-7, 1e-20);
  EXPECT_NEAR(statistics.of(&trial::MoveOutcome::overshoot).mean, 2.0 / 3.0, 1e-15);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::overshoot).max, 2.0);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::peak_torque).max, 0.05);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::reversal_depth).max, 7.0);
}

TEST(PointStatistics, FinalErrorsAreAbsoluteAndSkipNonfiniteMoves) {
  PointAccumulator point;
  for (const std::int64_t error : {-7, 2, 0, 1, -1}) {
    trial::MoveOutcome move = move_that(trial::Outcome::oscillating, never);
    move.final_error = error;
    point.add({{move}}, {});
  }
  trial::MoveOutcome lost = move_that(trial::Outcome::nonfinite, never);
  lost.final_error = 1000;
  point.add({{lost}}, {});
  const MeasureStatistics errors = point.statistics().of(&trial::MoveOutcome::final_error);
  EXPECT_EQ(errors.n, 5);
  EXPECT_EQ(errors.mean, 11.0 / 5.0);
  EXPECT_EQ(errors.median.value, 1.0);
  EXPECT_EQ(errors.p95.value, 7.0);
  EXPECT_EQ(errors.max, 7.0);
}

TEST(PointStatistics, TrueErrorsAreAbsoluteAndSkipMovesWithoutOne) {
  PointAccumulator point;
  for (const double error : {-4.0, 0.0, 2.5, never}) {
    trial::MoveOutcome move = move_that(trial::Outcome::zero_count, 0.1);
    move.true_error = error;
    point.add({{move}}, {});
  }
  const MeasureStatistics errors = point.statistics().of(&trial::MoveOutcome::true_error);
  EXPECT_EQ(errors.n, 3);
  EXPECT_EQ(errors.mean, 6.5 / 3.0);
  EXPECT_DOUBLE_EQ(errors.rms, std::sqrt((16.0 + 6.25) / 3.0));
  EXPECT_EQ(errors.max, 4.0);
  EXPECT_TRUE(std::isnan(statistics::Moments{}.rms()));
}

TEST(PointStatistics, PhaseChangesAndDisagreementsAreCountedPerTrial) {
  trial::MoveOutcome none = move_that(trial::Outcome::zero_count, 0.1), some = none;
  some.phase_changes = 3;
  some.encoder_disagreement = 10;
  some.travel_time = 0.5;
  PointAccumulator point;
  point.add({{none, none}}, {});
  point.add({{some, some}}, {});
  point.add({{none, some}}, {});
  const PointSummary statistics = point.statistics();
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::phase_changes).trials, 2);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::phase_changes).total, 9);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::phase_changes).max, 6);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::encoder_disagreement).trials, 2);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::encoder_disagreement).total, 30);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::encoder_disagreement).max, 20);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::travel_time).mean, 0.25);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::travel_time).max, 0.5);
}

TEST(PointStatistics, TrialsThatContradictThemselvesAreRefused) {
  const trial::MoveOutcome move = move_that(trial::Outcome::zero_count, 0.1);
  trial::MoveOutcome jerking = move;
  jerking.jerk_count = 2;
  const trial::Jerk early{0, 0.2, 0.01, 1, 1}, late{0, 0.4, 0.01, 1, 1}, elsewhere{1, 0.2, 0.01, 1, 1};

  EXPECT_THROW(PointAccumulator().add({}, {}), Failure) << "no move";
  EXPECT_THROW(PointAccumulator().add({{move}}, std::vector<trial::Jerk>{early}), Failure)
      << "a jerk not counted";
  EXPECT_THROW(PointAccumulator().add({{jerking}}, std::vector<trial::Jerk>{early}), Failure)
      << "a jerk missing";
  EXPECT_THROW(PointAccumulator().add({{jerking}}, std::vector<trial::Jerk>{late, early}), Failure)
      << "out of order";
  EXPECT_THROW(PointAccumulator().add({{move}}, std::vector<trial::Jerk>{elsewhere}), Failure)
      << "of no move";
  PointAccumulator point;
  point.add({{move}}, {});
  EXPECT_THROW(point.add({{move, move}}, {}), Failure) << "another number of moves";
}

}  // namespace
}  // namespace zerocount::measures
