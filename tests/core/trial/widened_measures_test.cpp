// What is measured of every move of random trials, by the definitions of the measures and the recorded
// samples; and that these trials show all of it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/trial/literal_measures.hpp"
#include "tests/core/trial/recorded_trials.hpp"

namespace zerocount::testing {
namespace {

/// The deepest stack of reversal points at the samples of a move and at its end.
std::int64_t deepest_sample(const RecordedTrial& trial, const MoveSpan& span) {
  std::int64_t depth = 0;
  const std::size_t last = std::min(span.first + span.size, trial.samples.size() - 1);
  for (std::size_t k = span.first; k <= last; ++k) depth = std::max(depth, trial.samples[k].depth);
  return depth;
}

TEST(WidenedMeasures, AreThoseOfTheSamplesOfEachMove) {
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

TEST(WidenedMeasures, TellOfTheJerksOfEachMove) {
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

/// How often the trials show what the tests are about.
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
      seen["settled for good later than at first"] += m.final_settling_time > m.settling_time;
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

TEST(WidenedMeasures, SeeAllThatThereIsToMeasure) {
  for (const auto& [sight, times] : sights()) EXPECT_GE(times, 3) << sight;
}

}  // namespace
}  // namespace zerocount::testing
