// Moves that are off target: how many, and the hold that would decide them.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/trials/measures/undecided_moves.hpp"
#include "core/trial/last_half.hpp"
#include "core/trial/trial.hpp"
#include "tests/analysis/summary_forms.hpp"
#include "tests/analysis/trials/summary/swept_study.hpp"

namespace zerocount::summary {
namespace {

// An exponential read in whole counts: the estimate is as good as the rounding of its two errors allows.
TEST(TimeToZero, IsExactForAnExponentialDecay) {
  std::mt19937_64 random(3);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  constexpr double sample_time = 0.001;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t samples = 100 + static_cast<std::int64_t>(random() % 2000);
    const double tau = uniform(0.2, 2.0) * static_cast<double>(samples) * sample_time;
    const double start = uniform(100.0, 10'000.0);
    const auto error_at = [&](std::int64_t k) {
      return start * std::exp(-static_cast<double>(k) * sample_time / tau);
    };
    const std::int64_t midway = std::llround(error_at(trial::first_of_last_half(samples)));
    const std::int64_t final_error = std::llround(error_at(samples - 1));
    if (final_error < 20 || final_error == midway) continue;
    const double zero = tau * std::log(2.0 * start);
    const double decay = std::log(static_cast<double>(midway) / static_cast<double>(final_error));
    EXPECT_NEAR(measures::time_to_zero(midway, final_error, samples, sample_time), zero,
                zero * (0.01 + 1.5 / (static_cast<double>(final_error) * decay)));
    EXPECT_EQ(measures::time_to_zero(-midway, -final_error, samples, sample_time),
              measures::time_to_zero(midway, final_error, samples, sample_time));
  }
}

// The machine of the paper with gains at which no move arrives within the hold: the advice decides most of
// them.
TEST(TimeToZero, AHoldOfThatLengthDecidesMostMovesOfASlowLoop) {
  for (const double ki : {2.0e-7, 5.0e-7, 1.0e-6}) {
    int off_target = 0, decided = 0;
    for (std::int64_t target = 3; target <= 30; target += 3) {
      trial::TrialParameters p;
      p.controller.ki = ki;
      p.command.targets = {target};
      p.command.hold = 0.3;
      const trial::MoveOutcome move = trial::run_trial(p).moves[0];
      if (move.outcome != trial::Outcome::off_target ||
          std::abs(move.final_error) >= std::abs(move.midway_error))
        continue;
      ++off_target;
      p.command.hold = measures::time_to_zero(move.midway_error, move.final_error,
                                              trial::samples_of_move(p, 0), 1.0 / p.controller.sample_rate) +
                       p.verdict.dwell;
      const trial::Outcome later = trial::run_trial(p).moves[0].outcome;
      decided += later == trial::Outcome::zero_count || later == trial::Outcome::one_count;
    }
    EXPECT_GE(off_target, 7) << ki;
    EXPECT_GE(10 * decided, 7 * off_target) << ki;
  }
}

TEST(UndecidedMoves, AreReportedWithTheHoldThatWouldDecideThem) {
  EXPECT_EQ(measures::undecided_sentence({.moves = 3000}), "");
  EXPECT_EQ(
      measures::undecided_sentence({3000, 2736, 2700, 0, 0, 2.1}),
      "2736 of 3000 moves ended more than one count off their target without oscillating; the error was "
      "still falling in 2700 of 3000 moves at the end of the hold; hold ≥ about 2.1 s");
  EXPECT_EQ(
      measures::undecided_sentence({.moves = 10, .off_target = 4}),
      "4 of 10 moves ended more than one count off their target without oscillating; in none of them was "
      "the error still falling: they have stalled");
}

TEST(UndecidedMoves, IncludeMovesThatOnlySeemToOscillate) {
  EXPECT_EQ(
      measures::undecided_sentence({300, 184, 183, 53, 29, 1.5}),
      "184 of 300 moves ended more than one count off their target without oscillating; the error was still "
      "falling in 183 of 300 moves at the end of the hold; it was falling, with a ripple of one count, in 53 "
      "more that count as oscillating; it had fallen to within one count, without arrival, in 29 more; hold "
      "≥ "
      "about 1.5 s");
}

TEST(UndecidedMoves, AreReportedForThePointsThatHaveSome) {
  StudySummary study = swept_study(std::vector<measures::PointSummary>(2));
  study.labels = {"fast", "slow"};
  for (measures::PointSummary& point : study.points) point.trials = 10;
  study.points[1].undecided = {3000, 2736, 2700, 0, 0, 2.1};
  const std::string text = testing::summary_text(study);
  const std::size_t begin = text.find("undecided moves:"),
                    end = text.find("neither stable nor shown unstable");
  ASSERT_LT(begin, end) << text;
  ASSERT_NE(end, std::string::npos) << text;
  const std::string part = text.substr(begin, end - begin);
  EXPECT_EQ(part.find("fast"), std::string::npos) << part;
  EXPECT_NE(part.find("slow: 2736 of 3000"), std::string::npos) << part;
  const nlohmann::ordered_json json = testing::summary_json(study)["points"][1]["undecided"];
  EXPECT_EQ(json["hold_at_least"], 2.1);
  EXPECT_EQ(json["still_falling"], 2700);
  EXPECT_NE(testing::summary_csv(study).find(",still_falling_moves,"), std::string::npos);
  study.points[1].undecided = {};
  EXPECT_EQ(testing::summary_text(study).find("neither stable nor shown"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::summary
