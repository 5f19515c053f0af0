// All of a trial around its plant, from random runs of it: what was commanded, decided and driven at every
// sample and what the encoders showed, each computed independently from the equations in core/README.md and
// the recorded samples.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/trial/literal_command.hpp"
#include "tests/core/trial/literal_control.hpp"
#include "tests/core/trial/literal_rig.hpp"
#include "tests/core/trial/recorded_trials.hpp"

namespace zerocount::testing {
namespace {

TEST(WidenedTrial, HasTheSamplesOfItsMovesInOrder) {
  for_each_trial([](const RecordedTrial& trial) {
    for (std::size_t k = 0; k < trial.samples.size(); ++k) {
      ASSERT_EQ(trial.samples[k].k, static_cast<std::int64_t>(k));
      ASSERT_NEAR(trial.samples[k].t * trial.parameters.controller.sample_rate, static_cast<double>(k), 1e-9);
    }
  });
}

TEST(WidenedTrial, HasTheTargetAndTheErrorOfItsMoveAtEverySample) {
  for_each_trial([](const RecordedTrial& trial) {
    for_each_move(trial, [&](std::size_t move, const MoveSpan& span) {
      const std::int64_t target = trial.is_open() ? 0 : trial.parameters.command.targets[move];
      for (std::size_t k = span.first; k < span.first + span.size; ++k) {
        ASSERT_EQ(trial.samples[k].target, target);
        ASSERT_EQ(trial.samples[k].error, target - trial.samples[k].count);
      }
    });
  });
}

TEST(WidenedTrial, FollowsTheFastestMotionWithinTheLimitsOfItsProfile) {
  for_each_trial([](const RecordedTrial& trial) {
    if (trial.is_open()) return;
    for_each_move(trial, [&](std::size_t move, const MoveSpan& span) {
      const LiteralMotion motion = literal_motion(trial.parameters, move);
      const std::int64_t from = move == 0 ? 0 : trial.parameters.command.targets[move - 1];
      for (std::size_t i = 0; i < span.size; ++i) {
        const trial::SampleRecord& sample = trial.samples[span.first + i];
        const long double t = static_cast<long double>(i) / trial.parameters.controller.sample_rate;
        const long double travelled = static_cast<long double>(sample.reference - from);
        ASSERT_LE(std::abs(travelled - literal_travel(motion, t)), 0.5L + 1e-6L) << "sample " << i;
      }
    });
  });
}

TEST(WidenedTrial, ReadsItsEncodersAtTheAngleOfTheRotor) {
  for_each_trial([](const RecordedTrial& trial) {
    const std::vector<std::int64_t> fine = literal_fine_counts(trial.parameters, trial.samples);
    const std::vector<std::int64_t> coarse = literal_coarse_counts(trial.parameters, trial.samples);
    for (std::size_t k = 0; k < trial.samples.size(); ++k) {
      ASSERT_EQ(trial.samples[k].count, fine[k]) << "sample " << k;
      ASSERT_EQ(trial.samples[k].coarse_count, coarse[k]) << "sample " << k;
    }
  });
}

TEST(WidenedTrial, IsInThePhaseThatItsCountsAskFor) {
  for_each_trial([](const RecordedTrial& trial) {
    const std::vector<LiteralDecision> decisions = literal_decisions(trial.parameters, trial.samples);
    for (std::size_t k = 0; k < trial.samples.size(); ++k) {
      ASSERT_EQ(trial.samples[k].phase, trial.is_open() ? loop::ControlPhase::fine : decisions[k].phase)
          << "sample " << k;
    }
  });
}

TEST(WidenedTrial, DecidesTheTorqueOfItsLawOrLevel) {
  for_each_trial([](const RecordedTrial& trial) {
    const loop::DacParameters& dac = trial.parameters.dac;
    const long double most = std::ldexp(1.0L, dac.bits - 1);
    const std::vector<long double> wanted = wanted_torques(trial);
    for (std::size_t k = 0; k < trial.samples.size(); ++k) {
      const trial::SampleRecord& sample = trial.samples[k];
      if (trial.is_exact()) {
        ASSERT_EQ(sample.code, 0);
        ASSERT_NEAR(sample.torque, static_cast<double>(wanted[k]), 1e-14) << "sample " << k;
        continue;
      }
      const long double codes = std::clamp(wanted[k] / dac.resolution, -most, most - 1);
      ASSERT_LE(std::abs(static_cast<long double>(sample.code) - codes), 0.5L + 1e-7L) << "sample " << k;
      ASSERT_EQ(sample.torque, static_cast<double>(sample.code) * dac.resolution) << "sample " << k;
    }
  });
}

TEST(WidenedTrial, DrivesItsMotorThroughConverterDelayAndAmplifier) {
  for_each_trial([](const RecordedTrial& trial) {
    const auto drive = literal_drive(trial.parameters, trial.samples);
    for (std::size_t k = 0; k < trial.samples.size(); ++k) {
      const LiteralDrive& first = drive[k][drive[k][0].time > 0 ? 0 : 1];
      ASSERT_NEAR(trial.samples[k].drive_torque, static_cast<double>(first.output), 1e-14) << "sample " << k;
    }
  });
}

}  // namespace
}  // namespace zerocount::testing
