// A recorded torque: what acts at a time, and how long it lasts.
#include "core/trial/torque_record.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "core/trial/trial.hpp"

namespace zerocount::trial {
namespace {

TEST(TorqueRecord, HoldsEachValueUntilTheNext) {
  const TorqueRecord record{{0.0, 0.25, 1.0}, {3.0, -1.0, 2.0}};
  EXPECT_EQ(torque_at(record, 0.0), 3.0);
  EXPECT_EQ(torque_at(record, 0.2499), 3.0);
  EXPECT_EQ(torque_at(record, 0.25), -1.0);
  EXPECT_EQ(torque_at(record, 0.999), -1.0);
  EXPECT_EQ(torque_at(record, 1.0), 2.0);
  EXPECT_EQ(torque_at(record, 1e9), 2.0);
  EXPECT_EQ(duration(record), 1.75);
}

// 3·0.1 is above 0.3, and 7·0.001 below a time that is written as 0.007.
TEST(TorqueRecord, RoundingShiftsNoSample) {
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
TEST(TorqueRecord, IsATrialOfLevelsOfASample) {
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

}  // namespace
}  // namespace zerocount::trial
