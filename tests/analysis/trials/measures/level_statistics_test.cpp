#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/trials/measures/point_accumulator.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/study_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::measures {
namespace {

trial::MoveOutcome level_that(double torque, double position) {
  trial::MoveOutcome move;
  move.outcome = trial::Outcome::open_loop;
  move.holding_torque = torque;
  move.final_position = position;
  return move;
}

TEST(Levels, AreCountedAndNotJudged) {
  PointAccumulator point({.open_loop = true});
  for (int i = 0; i < 8; ++i) point.add({{level_that(0.1, 1e-4), level_that(0.0, 1e-5)}}, {});
  const PointSummary statistics = point.statistics();
  EXPECT_EQ(statistics.trials, 8);
  EXPECT_EQ(statistics.judged, 0);
  EXPECT_EQ(statistics.outcomes.open_loop, 8);
  EXPECT_EQ(statistics.outcomes.zero_count, 0);
  EXPECT_EQ(statistics.by_move[1].open_loop, 8);
  for (const RateWithBounds& rate :
       {statistics.success_rate(), statistics.of(&trial::MoveOutcome::stable).rate}) {
    EXPECT_TRUE(std::isnan(rate.value));
    EXPECT_TRUE(std::isnan(rate.clopper_pearson.low) && std::isnan(rate.clopper_pearson.high));
    EXPECT_TRUE(std::isnan(rate.wilson.low) && std::isnan(rate.wilson.high));
  }
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::final_error).n, 0);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::true_error).n, 0);
  EXPECT_EQ(statistics.of(&trial::MoveOutcome::overshoot).n, 0);
  ASSERT_EQ(statistics.levels.size(), 2U);
  EXPECT_EQ(statistics.levels[0].of(&trial::MoveOutcome::holding_torque).mean, 0.1);
  EXPECT_EQ(statistics.levels[1].of(&trial::MoveOutcome::final_position).mean, 1e-5);
}

TEST(Levels, TrialsWithNonfiniteMotionAreLeftOut) {
  PointAccumulator point({.open_loop = true});
  point.add({{level_that(0.1, 1e-4), level_that(0.2, 3e-4)}}, {});
  point.add({{level_that(0.1, 2e-4), trial::MoveOutcome{}}}, {});
  const PointSummary statistics = point.statistics();
  EXPECT_EQ(statistics.outcomes.open_loop, 1);
  EXPECT_EQ(statistics.outcomes.nonfinite, 1) << "the worst of a trial's moves";
  EXPECT_TRUE(std::isnan(statistics.success_rate().value)) << "no trial was judged, lost ones neither";
  EXPECT_EQ(statistics.levels[0].of(&trial::MoveOutcome::final_position).n, 2);
  EXPECT_EQ(statistics.levels[0].nonfinite, 0);
  EXPECT_EQ(statistics.levels[1].of(&trial::MoveOutcome::final_position).n, 1);
  EXPECT_EQ(statistics.levels[1].of(&trial::MoveOutcome::final_position).mean, 3e-4);
  EXPECT_EQ(statistics.levels[1].nonfinite, 1);
}

TEST(Levels, BoundsHaveTheRequestedConfidence) {
  PointAccumulator point({.open_loop = true});
  statistics::MomentSums positions;
  for (int i = 0; i < 5; ++i) {
    positions.add(1e-4 + 1e-6 * i);
    point.add({{level_that(0.1, 1e-4 + 1e-6 * i)}}, {});
  }
  const LevelStatistics wide = point.statistics({.confidence = 0.99}).levels[0];
  const LevelStatistics usual = point.statistics().levels[0];
  for (const LevelField& field : level_fields()) {
    if (text::flat_name(field) == "position_low") {
      EXPECT_EQ(field.value(wide), statistics::student_t(positions.moments(), 0.99).low);
      EXPECT_EQ(field.value(usual), statistics::student_t(positions.moments(), 0.95).low);
    }
    if (text::flat_name(field) == "position_mean") {
      EXPECT_EQ(field.value(wide), field.value(usual));
    }
  }
}

TEST(Levels, WithoutAUsableTrialAreUndefined) {
  PointAccumulator point({.open_loop = true});
  point.add({{trial::MoveOutcome{}}}, {});
  const PointSummary statistics = point.statistics();
  ASSERT_EQ(statistics.levels.size(), 1U);
  EXPECT_TRUE(std::isnan(statistics.success_rate().value));
  EXPECT_TRUE(std::isnan(statistics.levels[0].of(&trial::MoveOutcome::holding_torque).mean));
  EXPECT_EQ(statistics.levels[0].nonfinite, 1);
}

TEST(Levels, OpenAndClosedLoopMovesDoNotMix) {
  trial::MoveOutcome judged;
  judged.outcome = trial::Outcome::zero_count;
  EXPECT_THROW(PointAccumulator({.open_loop = true}).add({{judged}}, {}), Failure);
  EXPECT_THROW(PointAccumulator().add({{level_that(0.1, 1e-4)}}, {}), Failure);
}

TEST(Levels, StoredStatisticsAgreeWithNumPyAndSciPy) {
  const testing::TemporaryFolder folder;
  study::Study study = testing::plain_study(3, 60, 5);
  study.open_loop = true;
  std::vector<testing::TrialRecord> trials;
  for (std::int64_t row = 0; row < study::trial_count(study); ++row)
    trials.push_back(testing::random_open_loop_trial(row, study.moves));
  testing::write_study_file(folder / "study.h5", study, trials, [&](const reading::AllTrialsFile& file) {
    const std::vector<PointSummary> points = summary::study_statistics(file, study);
    return layout::StoredStatistics{point_columns(points), {level_table(points)}, {}};
  });
  const std::string command =
      fmt::format("{} {} levels {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_STATISTICS_JUDGE,
                  (folder / "study.h5").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(folder.read("out"), "(3, 5)\n");
}

}  // namespace
}  // namespace zerocount::measures
