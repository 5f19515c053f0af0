// The measures of a move, against their definitions and closed forms.
#include "core/trial/move_measures.hpp"

#include "tests/core/trial/literal_trial.hpp"
#include "tests/support/test.hpp"

namespace zerocount::trial {
namespace {

constexpr double sample_time = 0.001;  // s

/// A move of 8 to 47 samples with random errors (counts), which mostly fall to zero and leave it now and
/// then.
std::vector<std::int64_t> random_errors(std::mt19937_64& random) {
  const auto range = static_cast<std::int64_t>(random() % 4);
  const std::int64_t side = random() % 2 == 0 ? 1 : -1;
  std::vector<std::int64_t> errors(8 + random() % 40);
  auto error = static_cast<std::int64_t>(random() % 9);
  for (std::int64_t& e : errors) {
    e = side * error;
    const auto step = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * range + 1)) - range;
    if (random() % 2 == 0) error += error > 0 && random() % 3 > 0 ? -1 : step;
  }
  return errors;
}

TEST(MoveMeasures, MatchTheirDefinitionsForAnyErrors) {
  std::mt19937_64 random(5);
  std::vector<int> seen(6);
  for (int i = 0; i < 20'000; ++i) {
    const std::vector<std::int64_t> errors = random_errors(random);
    TrialParameters p;
    p.controller.sample_rate = 1.0 / sample_time;
    p.command.targets = {10};
    p.command.hold = static_cast<double>(errors.size()) * sample_time;
    p.verdict.dwell = 3.0 * sample_time;
    p.verdict.window = 4.0 * sample_time;  // within the last half
    p.verdict.bands = {.limits = {0, 1, 3}, .count = 3};
    const double torque = 0.1 * (static_cast<double>(random() % 3) - 1.0);
    MoveMeasures measures(move_timing(p, 0), 0);
    std::vector<SampleRecord> samples;
    std::vector<Jerk> jerks;
    for (const std::int64_t error : errors) {
      samples.push_back({.target = 10, .count = 10 - error, .error = error, .torque = torque});
      if (measures.add({10, 10 - error, torque, false, 0.0, 0.0})) jerks.push_back(measures.last_jerk());
    }
    if (measures.finish(false, 0, true)) jerks.push_back(measures.last_jerk());
    const testing::LiteralMeasures expected =
        testing::literal_measures(p, samples, std::vector<long double>(errors.size()), 0);
    MoveOutcome measured = measures.outcome();
    measured.true_error = expected.outcome.true_error;  // not by MoveMeasures
    testing::expect_same_measures(measured, expected.outcome);
    testing::expect_same_jerks(jerks, expected.jerks);
    ASSERT_FALSE(::testing::Test::HasFailure()) << "move " << i;
    ++seen[static_cast<std::size_t>(measured.outcome)];
  }
  for (const Outcome outcome :
       {Outcome::zero_count, Outcome::one_count, Outcome::off_target, Outcome::oscillating}) {
    EXPECT_GE(seen[static_cast<std::size_t>(outcome)], 100) << static_cast<int>(outcome);
  }
}

TEST(OutcomeOfMove, IsNonfiniteIfTheMotionBecameNonfinite) {
  MoveMeasures measures({sample_time, 4, 3, 4}, 0);
  measures.add({1, 1, 0.0, false, 0.0, 0.0});
  measures.finish(false, 0, false);
  EXPECT_EQ(measures.outcome().outcome, Outcome::nonfinite);
  EXPECT_FALSE(measures.outcome().stable);
}

TEST(ErrorBands, AreUnknownIfTheMoveWasStoppedOrNonfinite) {
  for (const bool stopped : {true, false}) {
    MoveMeasures measures({sample_time, 4, 1, 4}, 0);
    measures.add({1, 1, 0.0, false, 0.0, 0.0});
    if (stopped) measures.stop();
    measures.finish(false, 0, stopped);
    for (const BandOutcome& band : measures.outcome().bands) {
      EXPECT_TRUE(std::isnan(band.entry_time));
      EXPECT_TRUE(std::isnan(band.settling_time));
      EXPECT_TRUE(std::isnan(band.exits));
    }
  }
}

TEST(Torques, AreThePeakAndTheLastTorque) {
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

// Without a target there is nothing to arrive at, and no verdict; what the rotor did is measured all the
// same.
TEST(OpenLoop, IsMeasuredButNotJudged) {
  MoveMeasures measures({.sample_time = sample_time, .samples = 6, .dwell = 2, .window = 2, .judged = false},
                        0);
  for (const std::int64_t count : {0, 0, 0, 1, 0, 7})
    EXPECT_FALSE(measures.add({0, count, -0.01 * static_cast<double>(count), false, 0.5, 0.25}));
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

TEST(OpenLoop, IsNonfiniteIfTheMotionBecameNonfinite) {
  MoveMeasures measures({.sample_time = sample_time, .samples = 6, .judged = false}, 0);
  measures.add({0, 0, 0.0, false, 0.0, 0.0});
  measures.finish(false, 0, false);
  EXPECT_EQ(measures.outcome().outcome, Outcome::nonfinite);
}

// A cosine of known amplitude and period, read by an encoder: what the measures are for.
TEST(Oscillation, HasTheAmplitudeAndPeriodOfASine) {
  std::mt19937_64 random(71);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 200; ++i) {
    const double amplitude = uniform(3.0, 2000.0), period = uniform(8.0, 300.0), phase = uniform(0.0, 7.0);
    const double centre = uniform(-0.5, 0.5) * amplitude;
    MoveMeasures measures({sample_time, 4000, 3, 4}, 0);
    for (int k = 0; k < 4000; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / period + phase;
      measures.add({0, std::llround(centre + amplitude * std::cos(angle)), 0.0, false, 0.0, 0.0});
    }
    measures.finish(false, 0, true);
    const MoveOutcome& outcome = measures.outcome();
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

TEST(Oscillation, IsNotMeasuredIfTheMoveWasStopped) {
  MoveMeasures measures({sample_time, 6, 3, 4}, 0);
  for (const std::int64_t count : {0, 9, 0, 9, 0, 9}) measures.add({4, count, 0.0, false, 0.0, 0.0});
  measures.stop();
  measures.finish(false, 0, true);
  EXPECT_EQ(measures.outcome().outcome, Outcome::oscillating);
  EXPECT_TRUE(std::isnan(measures.outcome().oscillation_amplitude));
  EXPECT_TRUE(std::isnan(measures.outcome().oscillation_period));
}

// Whatever the errors do, the memory has a limit; then it is the latest rises that count.
TEST(Oscillation, UsesTheLastRisesIfThereAreMany) {
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

TEST(WorstOutcome, IsTheMostSevere) {
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
