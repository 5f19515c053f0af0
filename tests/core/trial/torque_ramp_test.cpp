// The torque between two commanded levels: a constant rate, sampled, that ends at the level itself.
#include "core/trial/open_loop.hpp"
#include "core/trial/parameters.hpp"
#include "core/trial/torque_record.hpp"
#include "core/trial/trial.hpp"
#include "tests/support/goodness_of_fit.hpp"
#include "tests/support/test.hpp"

namespace zerocount::trial {
namespace {

struct RandomRamp {
  double from, to, rate, sample_rate;
};

RandomRamp random_ramp(std::mt19937& random) {
  std::uniform_real_distribution<double> level(-0.3, 0.3);
  std::uniform_real_distribution<double> decade(-2.0, 1.0);
  return {level(random), level(random), std::pow(10.0, decade(random)), 2000.0};
}

TEST(TorqueRamp, RisesAtTheRateFromTheFirstSampleAndEndsAtTheLevel) {
  std::mt19937 random(20020721);
  for (int i = 0; i < 1000; ++i) {
    const RandomRamp r = random_ramp(random);
    const TorqueRamp ramp = make_torque_ramp(r.from, r.to, r.rate, r.sample_rate);
    const double step = r.rate / r.sample_rate;
    EXPECT_EQ(torque_at(ramp, 0), r.from);
    EXPECT_EQ(torque_at(ramp, ramp.samples), r.to);
    EXPECT_EQ(torque_at(ramp, ramp.samples + 12345), r.to);
    for (std::int64_t k = 0; k < ramp.samples; ++k) {
      const double change = torque_at(ramp, k + 1) - torque_at(ramp, k);
      const bool last = k + 1 == ramp.samples;
      EXPECT_GE(change * (r.to - r.from), 0.0);
      EXPECT_LE(std::abs(change), step * (1.0 + 1e-6));
      if (!last) {
        EXPECT_NEAR(std::abs(change), step, 1e-12);
      }
    }
  }
}

TEST(TorqueRamp, TakesTheTimeThatTheRateAsksRoundedUpToSamples) {
  EXPECT_EQ(make_torque_ramp(0.0, 0.1, 0.1, 2000.0).samples, 2000);
  EXPECT_EQ(make_torque_ramp(0.1, -0.2, 0.3, 2000.0).samples, 2000);  // whole, though 0.1 + 0.2 is not 0.3
  EXPECT_EQ(make_torque_ramp(0.0, 0.10001, 0.1, 2000.0).samples, 2001);
  EXPECT_EQ(make_torque_ramp(0.1, 0.1, 0.1, 2000.0).samples, 0);
}

TEST(TorqueRamp, MirrorsWithTheSignOfTheLevels) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const RandomRamp r = random_ramp(random);
    const TorqueRamp ramp = make_torque_ramp(r.from, r.to, r.rate, r.sample_rate);
    const TorqueRamp mirror = make_torque_ramp(-r.from, -r.to, r.rate, r.sample_rate);
    ASSERT_EQ(mirror.samples, ramp.samples);
    for (std::int64_t k = 0; k <= ramp.samples; ++k) EXPECT_EQ(torque_at(mirror, k), -torque_at(ramp, k));
  }
}

// A level's move is the way to it and then the hold.
TEST(TorqueRamp, IsPartOfTheMoveOfItsLevel) {
  TrialParameters parameters;
  parameters.command.torque.levels = {0.1, 0.1, -0.1};
  parameters.command.torque.rate = 0.2;
  parameters.command.hold = 0.25;
  EXPECT_EQ(move_count(parameters), 3U);
  EXPECT_EQ(samples_of_move(parameters, 0), 1000 + 500);
  EXPECT_EQ(samples_of_move(parameters, 1), 500);
  EXPECT_EQ(samples_of_move(parameters, 2), 2000 + 500);
  EXPECT_EQ(samples_of_trial(parameters), 4500);
}

// A recorded torque: what acts at a time, and how long it lasts.

TEST(TorqueRecord, HoldsEachValueUntilTheNext) {
  const TorqueRecord record{{0.0, 0.25, 1.0}, {3.0, -1.0, 2.0}};
  EXPECT_EQ(torque_at(record, 0.0), 3.0);
  EXPECT_EQ(torque_at(record, 0.2499), 3.0);
  EXPECT_EQ(torque_at(record, 0.25), -1.0);
  EXPECT_EQ(torque_at(record, 0.999), -1.0);
  EXPECT_EQ(torque_at(record, 1.0), 2.0);
  EXPECT_EQ(torque_at(record, 1e9), 2.0);
}

TEST(TorqueRecord, LastRowLastsAsLongAsTheOneBefore) {
  EXPECT_EQ(record_duration(TorqueRecord{{0.0, 0.5, 0.75}, {0.0, 0.0, 0.0}}), 1.0);
}

// 3·0.1 is above 0.3, and 7·0.001 below a time that is written as 0.007.
TEST(TorqueRecord, RoundingOfTimesShiftsNoSample) {
  for (const double rate : {10.0, 1000.0, 2048.0, 3000.0}) {
    TorqueRecord record;
    for (int k = 0; k < 5000; ++k) {
      record.time.push_back(static_cast<double>(k) / rate * (k % 2 == 0 ? 1.0 + 1e-14 : 1.0 - 1e-14));
      record.torque.push_back(k);
    }
    for (int k = 0; k < 5000; ++k) EXPECT_EQ(torque_at(record, k * (1.0 / rate)), k) << rate;
  }
}

// Under each of its samples the trial is that of torque levels of one sample each.
TEST(TorqueRecord, EqualsATrialWithOneLevelPerSample) {
  TrialParameters levels;
  levels.friction.model = friction::FrictionModel::presliding;
  levels.command.torque.through = TorquePath::exact;
  levels.command.torque.rate = 1e300;
  levels.command.hold = 1.0 / levels.controller.sample_rate;
  TorqueRecord record;
  for (int k = 0; k < 400; ++k) {
    record.time.push_back(k / levels.controller.sample_rate);
    record.torque.push_back(0.4 * std::sin(0.05 * k) * (k < 300 ? 1.0 : 0.0));
  }
  levels.command.torque.levels = record.torque;
  TrialParameters recorded = levels;
  recorded.command.torque.levels = {0.0};
  recorded.command.hold = 400.0 / levels.controller.sample_rate;
  recorded.command.torque.record = std::make_shared<const TorqueRecord>(record);
  const auto angles_of = [](const TrialParameters& parameters) {
    std::vector<double> angles;
    TrialObservers observers;
    observers.sample = [&](const SampleRecord& sample) { angles.push_back(sample.theta); };
    run_trial(parameters, observers);
    return angles;
  };
  const std::vector<double> angles = angles_of(recorded);
  ASSERT_EQ(angles.size(), 400u);
  EXPECT_EQ(angles, angles_of(levels));
  EXPECT_GT(*std::max_element(angles.begin(), angles.end()), 1e-3) << "it slides";
  const TrialOutcome outcome = run_trial(recorded);
  ASSERT_EQ(outcome.moves.size(), 1u);
  EXPECT_EQ(outcome.moves[0].outcome, Outcome::open_loop);
}

// Random histories: by turns up and down, evenly between the last level and the largest torque.

constexpr double largest = 0.25;

random::TrialRandomness randomness_of(std::uint64_t trial) {
  random::TrialRandomness randomness;
  randomness.trial = trial;
  randomness.history = {21, 22};
  return randomness;
}

TEST(RandomHistory, IsEmptyWithoutReversals) {
  EXPECT_TRUE(draw_history({0, largest}, randomness_of(1)).empty());
}

TEST(RandomHistory, ReversesAtEveryLevelAndStaysWithinTheTorque) {
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    const std::vector<double> levels = draw_history({12, largest}, randomness_of(trial));
    ASSERT_EQ(levels.size(), 12u);
    double direction = levels[0];
    double last = 0.0;
    for (const double level : levels) {
      ASSERT_GT((level - last) * direction, 0.0);
      ASSERT_LT(std::abs(level), largest);
      direction = -direction;
      last = level;
    }
  }
}

TEST(RandomHistory, FirstDirectionsAreBalancedAndLevelsUniform) {
  constexpr int trials = 20000;
  constexpr std::size_t reversals = 5;
  int upwards = 0;
  std::vector<std::vector<double>> places(
      reversals);  // of each level between the last and the largest torque
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    const std::vector<double> levels =
        draw_history({static_cast<int>(reversals), largest}, randomness_of(trial));
    if (levels[0] > 0.0) ++upwards;
    double outermost = std::copysign(largest, levels[0]);
    double last = 0.0;
    for (std::size_t i = 0; i < reversals; ++i) {
      places[i].push_back((levels[i] - last) / (outermost - last));
      outermost = -outermost;
      last = levels[i];
    }
  }
  EXPECT_NEAR(upwards, trials / 2.0, 3.5 * std::sqrt(trials / 4.0));
  for (const std::vector<double>& values : places) EXPECT_GT(testing::kolmogorov_probability(values), 1e-3);
  for (std::size_t i = 1; i < reversals; ++i) {
    double covariance = 0.0;
    for (std::size_t trial = 0; trial < trials; ++trial)
      covariance += (places[i][trial] - 0.5) * (places[i - 1][trial] - 0.5);
    EXPECT_LT(std::abs(covariance), 4.0 * std::sqrt(trials) / 12.0);
  }
}

}  // namespace
}  // namespace zerocount::trial
