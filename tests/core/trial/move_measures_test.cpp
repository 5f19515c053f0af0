// Every measure of a move, on hand-made error sequences.
#include "core/trial/move_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::trial {
namespace {

constexpr double sample_time = 0.001;  // s

struct Measured {
  MoveOutcome outcome;
  std::vector<Jerk> jerks;
};

/// Measures a move to `target` of the given errors, with a dwell of 3 and a window of 4 samples.
Measured measure(const std::vector<std::int64_t>& errors, std::int64_t target = 10, double torque = 0.1) {
  const MoveTiming timing{sample_time, static_cast<std::int64_t>(errors.size()), 3, 4};
  MoveMeasures measures(timing, 2);
  std::vector<Jerk> jerks;
  for (const std::int64_t error : errors) {
    if (measures.add({target, target - error, torque, false, 0.0, 0.0}))
      jerks.push_back(measures.last_jerk());
  }
  if (measures.finish(false, 0, true)) jerks.push_back(measures.last_jerk());
  return {measures.outcome(), jerks};
}

TEST(Arrival, IsTheFirstSampleOfTheFirstFullDwell) {
  EXPECT_EQ(measure({3, 1, 0, 0, 1, 0, 0, 0, 0}).outcome.arrival, 5);
  EXPECT_DOUBLE_EQ(measure({3, 1, 0, 0, 1, 0, 0, 0, 0}).outcome.settling_time, 0.005);
  EXPECT_EQ(measure({0, 0, 0, 1, 1}).outcome.arrival, 0);
  EXPECT_EQ(measure({5, 4, 0, 0, 0}).outcome.arrival, 2);  // the dwell may end with the move
}

TEST(Arrival, NeverIsNotANumber) {
  const MoveOutcome outcome = measure({3, 0, 0, 1, 0, 0, 1}).outcome;
  EXPECT_FALSE(outcome.arrived);
  EXPECT_EQ(outcome.arrival, -1);
  EXPECT_TRUE(std::isnan(outcome.settling_time));
  EXPECT_FALSE(outcome.stable);
}

TEST(OutcomeOfMove, IsDecidedByTheLastWindow) {
  EXPECT_EQ(measure({9, 5, 1, 0, 0, 0, 0}).outcome.outcome, Outcome::zero_count);
  EXPECT_EQ(measure({9, 5, 1, 0, 0, 0, -1}).outcome.outcome, Outcome::one_count);
  EXPECT_EQ(measure({9, 5, 0, 1, 0, 0, 0}).outcome.outcome,
            Outcome::one_count);  // the first of the last four
  EXPECT_EQ(measure({9, 5, 2, 0, 0, 0, 0}).outcome.outcome, Outcome::zero_count);
  EXPECT_EQ(measure({9, 5, 1, 0, 0, 2, 0}).outcome.outcome, Outcome::oscillating);
}

TEST(OutcomeOfMove, IsNonfiniteWhereTheMotionWasLost) {
  MoveMeasures measures({sample_time, 4, 3, 4}, 0);
  measures.add({1, 1, 0.0, false, 0.0, 0.0});
  measures.finish(false, 0, false);
  EXPECT_EQ(measures.outcome().outcome, Outcome::nonfinite);
  EXPECT_FALSE(measures.outcome().stable);
}

TEST(Stable, MeansArrivedAndNeverFurtherThanOneCountAfterwards) {
  EXPECT_TRUE(measure({5, 0, 0, 0, 1, -1, 0, 0}).outcome.stable);
  EXPECT_FALSE(measure({5, 0, 0, 0, 1, 2, 0, 0}).outcome.stable);
  EXPECT_TRUE(measure({5, 2, 0, 0, 0}).outcome.stable);  // before arrival anything goes
}

TEST(Jerks, AreTheExcursionsAfterTheDwell) {
  const Measured m = measure({5, 0, 0, 0, 0, -1, -1, 0, 0, 1, 0, -1, -2, -1, 0});
  ASSERT_EQ(m.jerks.size(), 3u);
  EXPECT_EQ(m.outcome.jerk_count, 3);
  EXPECT_EQ(m.jerks[0].move, 2);
  EXPECT_DOUBLE_EQ(m.jerks[0].onset, 0.005);
  EXPECT_DOUBLE_EQ(m.jerks[0].duration, 0.002);
  EXPECT_EQ(m.jerks[0].magnitude, 1);
  EXPECT_EQ(m.jerks[0].direction, 1);  // the count went beyond the target
  EXPECT_EQ(m.jerks[1].direction, -1);
  EXPECT_EQ(m.jerks[2].magnitude, 2);
  EXPECT_DOUBLE_EQ(m.jerks[2].duration, 0.003);
}

TEST(Jerks, DirectionIsThatOfTheOnset) {
  const Measured m = measure({0, 0, 0, -1, 1, 0, 0});
  ASSERT_EQ(m.jerks.size(), 1u);
  EXPECT_EQ(m.jerks[0].direction, 1);
}

TEST(Jerks, AreCutByTheEndOfTheMove) {
  const Measured m = measure({0, 0, 0, 0, 1, 1});
  ASSERT_EQ(m.jerks.size(), 1u);
  EXPECT_DOUBLE_EQ(m.jerks[0].duration, 0.002);
}

TEST(Jerks, AgreeWithTheHoldingTorqueInAShare) {
  const std::vector<std::int64_t> errors{0, 0, 0, -1, 0, -1, 0, 1, 0};
  EXPECT_DOUBLE_EQ(measure(errors, 10, 0.1).outcome.jerk_agreement, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(measure(errors, 10, -0.1).outcome.jerk_agreement, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(measure(errors, 10, 0.0).outcome.jerk_agreement, 0.0);
  EXPECT_TRUE(std::isnan(measure({0, 0, 0, 0}).outcome.jerk_agreement));
}

TEST(Overshoot, IsBeyondTheTargetInTheDirectionOfTheMove) {
  EXPECT_EQ(measure({5, 2, -3, -1, 0}).outcome.overshoot, 3);
  EXPECT_EQ(measure({-5, -2, 4, 1, 0}).outcome.overshoot, 4);
  EXPECT_EQ(measure({5, 6, 2, 0, 0}).outcome.overshoot, 0);   // going the wrong way first is not overshoot
  EXPECT_EQ(measure({0, 2, -2, 0, 0}).outcome.overshoot, 0);  // no move, no direction
}

TEST(Torques, ArePeakAndLast) {
  MoveMeasures measures({sample_time, 3, 1, 1}, 0);
  measures.add({0, 0, 0.1, false, 1.0, 0.5});
  measures.add({0, 0, -0.4, true, 2.0, 0.6});
  measures.add({0, 0, 0.2, false, 3.0, 0.7});
  measures.finish(true, 17, true);
  const MoveOutcome& outcome = measures.outcome();
  EXPECT_EQ(outcome.peak_torque, 0.4);
  EXPECT_EQ(outcome.holding_torque, 0.2);
  EXPECT_TRUE(outcome.saturated);
  EXPECT_TRUE(outcome.broke_away);
  EXPECT_EQ(outcome.reversal_depth, 17);
  EXPECT_EQ(outcome.final_position, 3.0);
  EXPECT_EQ(outcome.creep, 0.7);
}

TEST(FinalError, IsThatOfTheLastSample) {
  EXPECT_EQ(measure({9, 5, 1, 0, -3}).outcome.final_error, -3);
  EXPECT_EQ(measure({9, 5, 1, 0, 0}).outcome.final_error, 0);
}

// Without a target there is nothing to arrive at, and no verdict; what the rotor did is measured all the
// same.
TEST(OpenLoop, IsMeasuredButNotJudged) {
  MoveMeasures measures({.sample_time = sample_time, .samples = 6, .dwell = 2, .window = 2, .judged = false},
                        0);
  for (const std::int64_t count : {0, 0, 0, 1, 0, 7}) {
    EXPECT_FALSE(measures.add({0, count, -0.01 * static_cast<double>(count), false, 0.5, 0.25}));
  }
  EXPECT_FALSE(measures.finish(false, 3, true));
  const MoveOutcome& outcome = measures.outcome();
  EXPECT_EQ(outcome.outcome, Outcome::open_loop);
  EXPECT_FALSE(outcome.arrived);
  EXPECT_FALSE(outcome.stable);
  EXPECT_EQ(outcome.jerk_count, 0);
  EXPECT_EQ(outcome.overshoot, 0);
  EXPECT_EQ(outcome.final_error, -7);
  EXPECT_EQ(outcome.holding_torque, -0.07);
  EXPECT_EQ(outcome.peak_torque, 0.07);
  EXPECT_EQ(outcome.final_position, 0.5);
  EXPECT_EQ(outcome.creep, 0.25);
  EXPECT_EQ(outcome.reversal_depth, 3);
}

TEST(OpenLoop, IsNonfiniteWhereTheMotionWasLost) {
  MoveMeasures measures({.sample_time = sample_time, .samples = 6, .judged = false}, 0);
  measures.add({0, 0, 0.0, false, 0.0, 0.0});
  measures.finish(false, 0, false);
  EXPECT_EQ(measures.outcome().outcome, Outcome::nonfinite);
}

TEST(OutcomeOfMove, IsOffTargetWhereTheErrorKeepsItsSideAndDoesNotGrow) {
  EXPECT_EQ(measure({9, 8, 7, 6, 5, 5, 4, 3}).outcome.outcome, Outcome::off_target);  // still falling
  EXPECT_EQ(measure({9, 5, 4, 4, 4, 4, 4, 4}).outcome.outcome, Outcome::off_target);  // stalled
  EXPECT_EQ(measure({-9, 5, 4, -4, -4, -2, -3, -4}).outcome.outcome, Outcome::off_target);
  EXPECT_EQ(measure({9, 5, 4, 4, 4, 4, 4, 5}).outcome.outcome, Outcome::oscillating);     // grows
  EXPECT_EQ(measure({9, 5, 4, 4, 4, 0, 2, 2}).outcome.outcome, Outcome::oscillating);     // had come to zero
  EXPECT_EQ(measure({9, 5, 4, 4, 4, -1, -2, -2}).outcome.outcome, Outcome::oscillating);  // other side
  EXPECT_EQ(measure({9, 5, 4, 4, 4, 3, 2, 1}).outcome.outcome, Outcome::off_target);
}

// Sample ⌈N/2⌉ is the first that counts: of seven samples the fifth, of eight the fifth.
TEST(OutcomeOfMove, LooksAtTheLastHalfOfTheSamples) {
  EXPECT_EQ(measure({9, 9, 1, -9, 5, 4, 3}).outcome.outcome, Outcome::off_target);
  EXPECT_EQ(measure({9, 9, 1, -9, 3, 4, 3}).outcome.outcome, Outcome::oscillating);
  EXPECT_EQ(measure({9, 9, 1, -9, 5, 4, 3, 3}).outcome.outcome, Outcome::off_target);
  EXPECT_EQ(measure({9, 9, 9, -9, 5, 4, 3}).outcome.midway_error, 5);
  EXPECT_EQ(measure({9, 9, 9, -9, 5, 4, 3, 3}).outcome.midway_error, 5);
}

TEST(FinalSettlingTime, IsThatOfTheLastZerosInARow) {
  EXPECT_DOUBLE_EQ(measure({3, 0, 0, 0, 1, 0, 0, 0, 0}).outcome.final_settling_time, 0.005);
  EXPECT_DOUBLE_EQ(measure({3, 1, 1, 1, 0}).outcome.final_settling_time, 0.004);  // it needs no dwell
  EXPECT_DOUBLE_EQ(measure({0, 0, 0, 0}).outcome.final_settling_time, 0.0);
  EXPECT_TRUE(std::isnan(measure({3, 0, 0, 0, 0, 0, 1}).outcome.final_settling_time));
}

TEST(ZeroFraction, IsOfTheSamplesFromArrivalOn) {
  EXPECT_DOUBLE_EQ(measure({3, 1, 0, 0, 0, 1, 0, 0, -1, -1}).outcome.zero_fraction, 5.0 / 8.0);
  EXPECT_DOUBLE_EQ(measure({3, 1, 0, 0, 0, 0}).outcome.zero_fraction, 1.0);
  EXPECT_TRUE(std::isnan(measure({3, 1, 0, 0, 1, 0, 0}).outcome.zero_fraction));
}

// A cosine of known amplitude and period, read by an encoder: what the measures are for.
TEST(Oscillation, OfASineHasItsAmplitudeAndPeriod) {
  std::mt19937_64 random(71);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 200; ++i) {
    const double amplitude = uniform(3.0, 2000.0), period = uniform(8.0, 300.0), phase = uniform(0.0, 7.0);
    const double centre = uniform(-0.5, 0.5) * amplitude;
    std::vector<std::int64_t> errors;
    for (int k = 0; k < 4000; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / period + phase;
      errors.push_back(std::llround(centre + amplitude * std::cos(angle)));
    }
    const MoveOutcome outcome = measure(errors).outcome;
    ASSERT_EQ(outcome.outcome, Outcome::oscillating) << amplitude << ' ' << period << ' ' << phase;
    // Samples may miss the peaks by half a sample time; rounding adds half a count.
    const double missed = amplitude * (1.0 - std::cos(std::numbers::pi / period));
    EXPECT_NEAR(outcome.oscillation_amplitude, amplitude, missed + 0.51);
    // Each crossing is found within a sample, and where peaks are missed or rounded the middle is off.
    const double whole = std::floor(2000.0 / period) - 1.0;
    const double off = std::asin((missed + 1.0) / amplitude) / std::numbers::pi * period;
    EXPECT_NEAR(outcome.oscillation_period, period * sample_time, (1.5 + off) / whole * sample_time);
  }
}

TEST(Oscillation, IsMeasuredFromTheLastHalfOfAnOscillatingMoveAlone) {
  const Measured m = measure({90, -90, 90, -90, 2, 0, 2, 0, 2, 0, 2});
  EXPECT_EQ(m.outcome.outcome, Outcome::oscillating);
  EXPECT_DOUBLE_EQ(m.outcome.oscillation_amplitude, 1.0);
  EXPECT_DOUBLE_EQ(m.outcome.oscillation_period, 0.002);
  // One crossing has no period; moves that do not oscillate have neither.
  const MoveOutcome once = measure({9, 9, 9, 9, 4, 6, 6, 6}).outcome;
  EXPECT_DOUBLE_EQ(once.oscillation_amplitude, 1.0);
  EXPECT_TRUE(std::isnan(once.oscillation_period));
  for (const std::vector<std::int64_t>& errors :
       {std::vector<std::int64_t>{9, 8, 7, 6, 5, 4}, std::vector<std::int64_t>{9, 1, 0, 1, 0, 1, 0, 1}}) {
    EXPECT_TRUE(std::isnan(measure(errors).outcome.oscillation_amplitude));
    EXPECT_TRUE(std::isnan(measure(errors).outcome.oscillation_period));
  }
}

TEST(Oscillation, IsNotMeasuredOfAMoveThatWasEndedEarly) {
  MoveMeasures measures({sample_time, 6, 3, 4}, 0);
  for (const std::int64_t count : {0, 9, 0, 9, 0, 9}) measures.add({4, count, 0.0, false, 0.0, 0.0});
  measures.stop();
  measures.finish(false, 0, true);
  EXPECT_EQ(measures.outcome().outcome, Outcome::oscillating);
  EXPECT_TRUE(std::isnan(measures.outcome().oscillation_amplitude));
  EXPECT_TRUE(std::isnan(measures.outcome().oscillation_period));
}

// Whatever the errors do, the memory has a limit; then it is the latest rises that count.
TEST(Oscillation, OfManyRisesIsThatOfTheLastOnes) {
  LastHalf half;
  const auto rises = static_cast<std::int64_t>(LastHalf::max_rises);
  std::int64_t k = 0;
  const auto oscillate = [&](std::int64_t times, std::int64_t period) {
    for (std::int64_t i = 0; i < times; ++i, k += period) {
      half.add(k, 0, 10);
      half.add(k + 1, 10, 0);
    }
  };
  oscillate(1000, 6);
  oscillate(rises - 500, 4);
  half.finish(0);
  EXPECT_EQ(half.amplitude(), 5.0);
  EXPECT_DOUBLE_EQ(half.period(1.0),
                   static_cast<double>(500 * 6 + (rises - 501) * 4) / static_cast<double>(rises - 1));
}

// Random errors of all kinds: the outcomes exclude each other, and each measure is there where it should be.
TEST(MeasuresAtTheEnd, AreConsistentForAnyErrors) {
  std::mt19937_64 random(5);
  std::vector<int> seen(6);
  for (int i = 0; i < 20'000; ++i) {
    const std::size_t size = 8 + random() % 40;  // the window is within the last half
    const auto range = static_cast<std::int64_t>(random() % 4);
    std::vector<std::int64_t> errors(size);
    auto error = static_cast<std::int64_t>(random() % 9);
    for (std::int64_t& e : errors) {
      e = error;
      const auto step =
          static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * range + 1)) - range;
      if (random() % 2 == 0) error += error > 0 && random() % 3 > 0 ? -1 : step;
    }
    const MoveOutcome m = measure(errors).outcome;
    ++seen[static_cast<std::size_t>(m.outcome)];
    const auto half = errors.begin() + static_cast<std::ptrdiff_t>((size + 1) / 2);
    const auto [lowest, highest] = std::minmax_element(half, errors.end());
    EXPECT_EQ(m.midway_error, *half);
    EXPECT_EQ(std::isnan(m.final_settling_time), errors.back() != 0);
    EXPECT_EQ(std::isnan(m.zero_fraction), !m.arrived);
    EXPECT_EQ(std::isnan(m.oscillation_amplitude), m.outcome != Outcome::oscillating);
    if (m.arrived && errors.back() == 0) {
      EXPECT_GE(m.final_settling_time, m.settling_time);
      EXPECT_EQ(m.zero_fraction == 1.0, m.final_settling_time == m.settling_time);
    }
    if (m.outcome == Outcome::off_target) {
      EXPECT_FALSE(*lowest < 0 && *highest > 0);
      EXPECT_LE(std::max(std::abs(*lowest), std::abs(*highest)), std::abs(*half));
      EXPECT_GE(std::abs(*half), 2);
    }
    if (m.outcome != Outcome::oscillating) continue;
    EXPECT_EQ(m.oscillation_amplitude, 0.5 * static_cast<double>(*highest - *lowest));
    if (!std::isnan(m.oscillation_period)) {
      EXPECT_GE(m.oscillation_period, 2.0 * sample_time);
      EXPECT_LE(m.oscillation_period, static_cast<double>(size / 2) * sample_time);
    }
  }
  for (const Outcome outcome :
       {Outcome::zero_count, Outcome::one_count, Outcome::off_target, Outcome::oscillating}) {
    EXPECT_GE(seen[static_cast<std::size_t>(outcome)], 100) << static_cast<int>(outcome);
  }
}

TEST(WorstOutcome, IsByTheOrderOfSeverity) {
  constexpr Outcome order[] = {Outcome::zero_count, Outcome::one_count, Outcome::off_target,
                               Outcome::oscillating, Outcome::nonfinite};
  const auto worst_of = [](Outcome a, Outcome b) {
    std::vector<MoveOutcome> moves(2);
    moves[0].outcome = a;
    moves[1].outcome = b;
    return worst_outcome(moves);
  };
  for (std::size_t i = 0; i < std::size(order); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      EXPECT_EQ(worst_of(order[i], order[j]), order[i]);
      EXPECT_EQ(worst_of(order[j], order[i]), order[i]);
    }
  }
  EXPECT_EQ(worst_of(Outcome::open_loop, Outcome::open_loop), Outcome::open_loop);
  EXPECT_EQ(worst_of(Outcome::open_loop, Outcome::nonfinite), Outcome::nonfinite);
}

TEST(Timing, RoundsToWholeSamples) {
  TrialParameters parameters;
  parameters.command = {{1}, 0.15};
  parameters.verdict = {0.05, 0.0501};
  const MoveTiming timing = move_timing(parameters, 0);
  EXPECT_EQ(timing.samples, 300);
  EXPECT_EQ(timing.dwell, 100);
  EXPECT_EQ(timing.window, 100);
  EXPECT_DOUBLE_EQ(timing.sample_time, 5e-4);
}

}  // namespace
}  // namespace zerocount::trial
