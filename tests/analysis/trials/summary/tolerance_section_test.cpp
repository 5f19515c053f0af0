#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/measures/point_accumulator.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/summary_forms.hpp"
#include "tests/analysis/trials/summary/swept_study.hpp"

namespace zerocount::summary {
namespace {

trial::MoveOutcome arrived_after(double seconds) {
  trial::MoveOutcome move;
  move.outcome = trial::Outcome::zero_count;
  move.arrived = move.stable = true;
  move.arrival_time = seconds;
  return move;
}

trial::MoveOutcome never_arrived() {
  trial::MoveOutcome move;
  move.outcome = trial::Outcome::oscillating;
  return move;
}

/// Statistics of trials with two moves each; `lost` trials have a move that never arrives. `slowest` gets the
/// arrival time of the slower move of each other trial.
measures::PointAccumulator trials_of_two_moves(int trials, int lost, std::vector<double>& slowest) {
  std::mt19937_64 random(121);
  measures::PointAccumulator point;
  for (int i = 0; i < trials; ++i) {
    const double first = 0.0005 * static_cast<double>(random() % 900);
    const double second = 0.0005 * static_cast<double>(random() % 900);
    point.add({{arrived_after(first), i < lost ? never_arrived() : arrived_after(second)}}, {});
    if (i >= lost) slowest.push_back(std::max(first, second));
  }
  std::sort(slowest.begin(), slowest.end());
  return point;
}

TEST(ToleranceSection, LimitsAreThoseOfTheSlowestMoveOfEachTrial) {
  for (const int lost : {0, 3, 20}) {
    std::vector<double> slowest;
    const measures::PointSummary point = trials_of_two_moves(400, lost, slowest).statistics();
    for (std::size_t i = 0; i < std::size(statistics::tolerance_contents); ++i) {
      const statistics::ToleranceLimit& limit = point.settles_within.at(i);
      const auto rank =
          static_cast<std::size_t>(statistics::tolerance_rank(400, statistics::tolerance_contents[i], 0.95));
      EXPECT_EQ(limit.content, statistics::tolerance_contents[i]);
      if (rank <= slowest.size()) {
        EXPECT_EQ(limit.within, slowest[rank - 1]);
      } else {
        EXPECT_TRUE(std::isnan(limit.within)) << lost << " lost, content " << limit.content;
      }
    }
    EXPECT_EQ(std::isnan(point.settles_within[0].within), lost == 20);
  }
}

TEST(ToleranceSection, IsTheSameInEveryFormat) {
  std::vector<double> slowest;
  const std::vector<measures::PointSummary> points{
      trials_of_two_moves(400, 3, slowest).statistics({.confidence = 0.9}),
      trials_of_two_moves(100, 0, slowest).statistics({.confidence = 0.9})};
  StudySummary study = swept_study(points);
  study.confidence = 0.9;
  const nlohmann::ordered_json json = testing::summary_json(study);
  const std::string csv = testing::summary_csv(study);
  EXPECT_NE(csv.find(",success_at_least,failure_at_most,settling_within_95,settling_within_99,"
                     "settling_within_99_9\n"),
            std::string::npos)
      << csv;
  for (std::size_t i = 0; i < 2; ++i) {
    const nlohmann::ordered_json& assurance = json["points"][i]["assurance"];
    EXPECT_EQ(assurance["success_at_least"], points[i].claim.success_at_least);
    EXPECT_NE(
        csv.find(fmt::format(",{},{},{},", points[i].claim.success_at_least, points[i].claim.failure_at_most,
                             assurance["arrival_time"][0]["within"].get<double>())),
        std::string::npos);
    const std::string text = testing::summary_text(study, {.points = {static_cast<std::int64_t>(i)}});
    const std::string bound = text::percent_at_least(points[i].claim.success_at_least);
    EXPECT_NE(text.find(bound), std::string::npos) << text;
    EXPECT_NE(text.find("with 90 % confidence"), std::string::npos) << text;
    const auto statement = assurance["statement"].get<std::string>();
    EXPECT_EQ(statement.rfind(statistics::claim_sentence(points[i].claim), 0), 0U);
  }
  EXPECT_TRUE(json["points"][0]["assurance"]["rule_of_three"].is_null());
  EXPECT_NEAR(json["points"][1]["assurance"]["rule_of_three"].get<double>(), std::log(10.0) / 100.0, 1e-12);
}

TEST(ToleranceSection, BoundsOfMeansUseTheBootstrapOfTheirPoint) {
  std::vector<double> slowest;
  const measures::PointAccumulator point = trials_of_two_moves(60, 0, slowest);
  const measures::MeasureStatistics none = point.statistics().of(&trial::MoveOutcome::arrival_time);
  EXPECT_TRUE(std::isnan(none.mean_bounds.low));
  const measures::MeasureStatistics first =
      point.statistics({.bootstrap = measures::BootstrapDraws{7, 0}}).of(&trial::MoveOutcome::arrival_time);
  const measures::MeasureStatistics again =
      point.statistics({.bootstrap = measures::BootstrapDraws{7, 0}}).of(&trial::MoveOutcome::arrival_time);
  const measures::MeasureStatistics other =
      point.statistics({.bootstrap = measures::BootstrapDraws{7, 1}}).of(&trial::MoveOutcome::arrival_time);
  EXPECT_LT(first.mean_bounds.low, first.mean);
  EXPECT_GT(first.mean_bounds.high, first.mean);
  EXPECT_EQ(again.mean_bounds.low, first.mean_bounds.low);
  // The outer bounds are Student's or the bootstrap's: on one side at least its.
  EXPECT_NE(std::pair(other.mean_bounds.low, other.mean_bounds.high),
            std::pair(first.mean_bounds.low, first.mean_bounds.high));
}

TEST(ToleranceSection, AStudyStoppedByItsOutcomesClaimsLess) {
  std::vector<double> slowest;
  const measures::PointAccumulator point = trials_of_two_moves(400, 3, slowest);
  const measures::PointSummary planned = point.statistics();
  const measures::PointSummary stopped = point.statistics({.stopped_by_outcomes = true});
  EXPECT_LT(stopped.claim.success_at_least, planned.claim.success_at_least);
  EXPECT_GT(stopped.claim.success_at_least, 0.9);
  EXPECT_EQ(stopped.claim.failure_at_most, 1.0 - stopped.claim.success_at_least);
  for (const statistics::ToleranceLimit& limit : stopped.settles_within)
    EXPECT_TRUE(std::isnan(limit.within));
}

TEST(ToleranceSection, StatesMachinesIfTrialsShareThem) {
  measures::PointAccumulator on_machines({.shape = {.machines = 40}}), stopped({.shape = {.machines = 40}});
  for (int trial = 0; trial < 4000; ++trial) {
    const bool failed = trial % 40 == 3;  // one machine always does
    on_machines.add({{failed ? never_arrived() : arrived_after(0.05)}}, {});
    stopped.add({{failed ? never_arrived() : arrived_after(0.05)}}, {});
  }
  const std::vector<measures::PointSummary> points{on_machines.statistics()};
  const measures::PointSummary& point = points.front();
  EXPECT_EQ(point.machines.n, 40);
  EXPECT_NEAR(point.machines.without_failure, 39.0 / 40.0, 1e-15);
  EXPECT_NEAR(point.success_rate().value, 39.0 / 40.0, 1e-15);
  EXPECT_LT(point.success_rate().clopper_pearson.low, 0.9);  // of 4000 independent trials 0.97
  StudySummary study = swept_study(points);
  study.features.machines = true;
  const std::string text = testing::summary_text(study);
  EXPECT_NE(text.find("90 % of machines ≥"), std::string::npos) << text;
  EXPECT_NE(text.find(text::percent_at_least(point.machines.tolerance.zero_at_least)), std::string::npos)
      << text;
  const nlohmann::ordered_json assurance = testing::summary_json(study)["points"][0]["assurance"];
  const auto statement = assurance["statement"].get<std::string>();
  EXPECT_NE(statement.find("of trials on all machines succeed"), std::string::npos) << statement;
  EXPECT_NE(statement.find("(100 failures in 4000 trials on 40 machines)"), std::string::npos) << statement;
  EXPECT_EQ(assurance["machines"]["content"], 0.9);
  EXPECT_EQ(assurance["machines"]["zero_at_least"], point.machines.tolerance.zero_at_least);
  const measures::PointSummary decided = stopped.statistics({.stopped_by_outcomes = true});
  EXPECT_LE(decided.claim.success_at_least, point.claim.success_at_least);
  EXPECT_EQ(decided.machines.tolerance.min_machines, 0);
}

TEST(ToleranceSection, AConfidenceOfOneIsRefused) {
  std::vector<double> slowest;
  EXPECT_THROW(trials_of_two_moves(5, 0, slowest).statistics({.confidence = 1.0}), Failure);
}

}  // namespace
}  // namespace zerocount::summary
