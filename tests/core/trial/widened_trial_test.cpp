// All of a trial around its plant, from random runs of it: what was commanded, decided and driven at every
// sample and what the encoders showed, each computed independently from the equations in core/README.md and
// the recorded samples.
#include "core/trial/open_loop.hpp"
#include "tests/core/trial/literal_trial.hpp"
#include "tests/core/trial/recorded_trials.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/odeint_motion.hpp"
#include "tests/support/test.hpp"

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

TEST(WidenedTrial, IsInThePhaseThatItsCountsRequire) {
  for_each_trial([](const RecordedTrial& trial) {
    const std::vector<LiteralDecision> decisions = literal_decisions(trial.parameters, trial.samples);
    for (std::size_t k = 0; k < trial.samples.size(); ++k) {
      ASSERT_EQ(trial.samples[k].phase, trial.is_open() ? loop::ControlPhase::fine : decisions[k].phase)
          << "sample " << k;
    }
  });
}

TEST(WidenedTrial, CommandsTheTorqueOfItsLawOrLevel) {
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

// What is measured of every move of random trials, by the definitions of the measures and the recorded
// samples; and that these trials show all of it.

/// The largest number of remembered reversal points at the samples of a move and at its end.
std::int64_t deepest_sample(const RecordedTrial& trial, const MoveSpan& span) {
  std::int64_t depth = 0;
  const std::size_t last = std::min(span.first + span.size, trial.samples.size() - 1);
  for (std::size_t k = span.first; k <= last; ++k) depth = std::max(depth, trial.samples[k].depth);
  return depth;
}

TEST(WidenedMeasures, MatchTheSamplesOfEachMove) {
  for_each_trial([](const RecordedTrial& trial) {
    const std::vector<long double> wanted = wanted_torques(trial);
    for_each_move(trial, [&](std::size_t move, const MoveSpan& span) {
      const trial::MoveOutcome measured = trial.outcome.moves[move];
      const trial::MoveOutcome expected =
          literal_measures(trial.parameters, trial.samples, wanted, move).outcome;
      expect_same_measures(measured, expected);
      // The deepest may lie between two samples. Two reversals fit there at most, half a period of the spring
      // being longer than a sample: while the rotor creeps, dxs/dt may touch zero and come back at once.
      const std::int64_t depth = deepest_sample(trial, span);
      EXPECT_GE(measured.reversal_depth, depth);
      EXPECT_LE(measured.reversal_depth, depth + 2);
    });
  });
}

TEST(WidenedMeasures, CountTheJerksOfEachMove) {
  for_each_trial([](const RecordedTrial& trial) {
    const std::vector<long double> wanted = wanted_torques(trial);
    std::vector<trial::Jerk> expected;
    for_each_move(trial, [&](std::size_t move, const MoveSpan&) {
      for (const trial::Jerk& jerk : literal_measures(trial.parameters, trial.samples, wanted, move).jerks)
        expected.push_back(jerk);
    });
    expect_same_jerks(trial.jerks, expected);
  });
}

/// For each case that the tests are about, by name, the number of random trials in which it occurs.
std::map<std::string, std::int64_t> sights() {
  std::map<std::string, std::int64_t> seen;
  for_each_trial([&](const RecordedTrial& trial) {
    const trial::TrialParameters& p = trial.parameters;
    const long double highest = (std::ldexp(1.0L, p.dac.bits - 1) - 1.0L) * p.dac.resolution;
    if (!trial.is_open()) {
      for (const LiteralDecision& decision : literal_decisions(p, trial.samples)) {
        seen["integral at its bound"] += decision.integral == highest;
        seen["integral beyond the converter"] += decision.integral > highest;
      }
      seen["starts in the coarse phase with an integral"] +=
          trial.samples.front().phase == loop::ControlPhase::coarse && p.initial.integral != 0.0;
    }
    for_each_move(trial, [&](std::size_t move, const MoveSpan&) {
      const trial::MoveOutcome& m = trial.outcome.moves[move];
      seen["arrived"] += m.arrived;
      seen["stable"] += m.stable;
      seen["arrived, not stable"] += m.arrived && !m.stable;
      seen["zero count"] += m.outcome == trial::Outcome::zero_count;
      seen["one count"] += m.outcome == trial::Outcome::one_count;
      seen["oscillating"] += m.outcome == trial::Outcome::oscillating;
      seen["off target"] += m.outcome == trial::Outcome::off_target;
      seen["oscillation with a period"] += !std::isnan(m.oscillation_period);
      seen["oscillation without a period"] +=
          !std::isnan(m.oscillation_amplitude) && std::isnan(m.oscillation_period);
      seen["settled for good later than at first"] += m.final_settling_time > m.arrival_time;
      seen["away from zero after arrival"] += m.zero_fraction < 1.0;
      seen["open loop"] += m.outcome == trial::Outcome::open_loop;
      seen["jerks"] += m.jerk_count;
      seen["saturated"] += m.saturated;
      seen["broke away"] += m.broke_away;
      seen["overshoot"] += m.overshoot > 0;
      seen["travel of a reference"] += !trial.is_open() && m.travel_time > 0.0;
      seen["travel of a torque"] += trial.is_open() && m.travel_time > 0.0;
      seen["phase changes in the first move"] += move == 0 ? m.phase_changes : 0;
      seen["phase changes in a later move"] += move > 0 ? m.phase_changes : 0;
      seen["disagreements in the first move"] += move == 0 ? m.encoder_disagreement : 0;
      seen["disagreements in a later move"] += move > 0 ? m.encoder_disagreement : 0;
    });
  });
  return seen;
}

TEST(WidenedMeasures, RandomTrialsExerciseEveryMeasure) {
  for (const auto& [sight, times] : sights()) EXPECT_GE(times, 3) << sight;
}

// The motion of the plant in random trials, by Boost.odeint under the torque that their drive should have.

/// The motion of a trial as another integration gives it, beside the recorded one.
struct IntegratedMotion {
  /// The recorded samples, with the motion of the other integration.
  std::vector<trial::SampleRecord> samples;
  /// Number of breakaways before each sample, and before the end of the trial.
  std::vector<std::int64_t> breakaways;
};

IntegratedMotion integrate(const RecordedTrial& trial) {
  const trial::TrialParameters& p = trial.parameters;
  const auto drive = literal_drive(p, trial.samples);
  const long double amplifier = 2 * std::numbers::pi_v<long double> * p.amplifier.bandwidth;
  OdeintMotion motion(p, trial::draw_history(p.initial.history, p.randomness));
  IntegratedMotion integrated{trial.samples, {}};
  for (std::size_t k = 0; k < trial.samples.size(); ++k) {
    trial::SampleRecord& sample = integrated.samples[k];
    sample.theta = static_cast<double>(motion.theta());
    sample.xp = static_cast<double>(motion.state()[2]);
    sample.xh = static_cast<double>(motion.state()[3]);
    sample.mode = motion.sliding() ? trial::HookMode::slide : trial::HookMode::stick;
    integrated.breakaways.push_back(motion.events().breakaways);
    for (const LiteralDrive& part : drive[k]) {
      if (part.time > 0) motion.advance({part.output, part.input, amplifier}, part.time);
    }
  }
  integrated.breakaways.push_back(motion.events().breakaways);
  return integrated;
}

TEST(WidenedMotion, AgreesWithAnotherIntegrator) {
  Agreement total;
  std::size_t number = 0;
  for_each_trial([&](const RecordedTrial& trial) {
    if (number++ % 3 != 0) return;  // the other integrator is slow
    const IntegratedMotion integrated = integrate(trial);
    total.add(compare(trial.parameters, trial.samples, integrated.samples, trial.name));
    for_each_move(trial, [&](std::size_t move, const MoveSpan& span) {
      const bool slides = trial.samples[span.first].mode == trial::HookMode::slide;
      const bool breaks_away =
          integrated.breakaways[span.first + span.size] > integrated.breakaways[span.first];
      EXPECT_EQ(trial.outcome.moves[move].broke_away, slides || breaks_away);
    });
  });
  std::cout << total.figures() << "\n";
  for (const std::string& failure : total.failures) ADD_FAILURE() << failure;
  EXPECT_LT(total.before_breakaway, 1e-7);
  EXPECT_LT(total.after_breakaway_ratio, 0.1);
}

}  // namespace
}  // namespace zerocount::testing
