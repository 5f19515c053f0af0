// friction-models, hunting, deadband, observer, resonance and notch: what other laws of friction and other
// blocks of the controller change.
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "core/friction/sliding/sliding.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "experiments/study/study.hpp"
#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

std::int64_t moves_at_zero(const std::string& study, const std::string& point, std::int64_t trials) {
  return moves_with(outcomes_of(shipped_study(study), point, trials), [](const trial::MoveOutcome& move) {
    return move.outcome == trial::Outcome::zero_count;
  });
}

std::int64_t stable_moves(const std::string& study, const std::string& point, std::int64_t trials) {
  return moves_with(outcomes_of(shipped_study(study), point, trials),
                    [](const trial::MoveOutcome& move) { return move.stable; });
}

TEST(FrictionModels, ModelsWithASpringAndDampingHoldZeroCounts) {
  for (const char* law : {"presliding", "lugre", "dahl", "gms-damped"})
    EXPECT_TRUE(proportion_above(0.85, moves_at_zero("friction-models", law, 60), 60)) << law;
  for (const char* law : {"coulomb", "none"})
    EXPECT_TRUE(proportion_below(0.15, moves_at_zero("friction-models", law, 60), 60)) << law;
}

TEST(FrictionModels, OnlyModelsWithCreepShowJerks) {
  const auto with_jerks = [](const char* law) {
    return moves_with(outcomes_of(shipped_study("friction-models"), law, 60),
                      [](const trial::MoveOutcome& move) { return move.jerk_count > 0; });
  };
  EXPECT_TRUE(proportion_above(0.4, with_jerks("presliding"), 60));
  for (const char* law : {"lugre", "dahl", "gms-damped"}) EXPECT_EQ(with_jerks(law), 0) << law;
}

struct Cycle {
  double amplitude;  // rad
  double period;     // s
};

/// The stick-slip cycle of a continuous PID control on Coulomb friction, slide by slide: Armstrong and Amin,
/// "PID control in the presence of static friction", Automatica 32 (1996), 679-692.
Cycle stick_slip_cycle(const trial::TrialParameters& p) {
  const theory::AnalogueGains gains = theory::analogue_gains(p.controller, p.encoder);
  const friction::StribeckCurve level = friction::stribeck_curve(p.friction.uniform);
  const double breakaway = p.friction.uniform.breakaway;
  constexpr double dt = 2e-5;  // s
  double error = 0.01;         // of a rotor that is about to slide towards its target
  double integral = breakaway - gains.kp * error;
  Cycle half{0.0, 0.0};
  for (int slide = 0; slide < 40; ++slide) {
    const double before = error;
    double velocity = 0.0;
    double time = 0.0;
    do {
      const double torque = gains.kp * error + integral - (gains.kd + p.plant.sliding_damping) * velocity;
      velocity +=
          dt * (torque - friction::level_at(level, velocity)) / p.plant.inertia + (time == 0.0) * 1e-9;
      error -= dt * velocity;
      integral += dt * gains.ki * error;
      time += dt;
    } while (velocity > 0.0);
    const double stuck = (-breakaway - gains.kp * error - integral) / (gains.ki * error);
    half = {0.5 * (before - error), time + stuck};
    integral = breakaway + gains.kp * error;  // seen from the other side
    error = -error;
  }
  return {half.amplitude, 2.0 * half.period};
}

TEST(Hunting, HasTheAmplitudeAndThePeriodOfTheStickSlipCycle) {
  const study::Study study = shipped_study("hunting");
  for (const char* point :
       {"controller.ki=10, friction.coulomb_ratio=0.6", "controller.ki=40, friction.coulomb_ratio=0.9"}) {
    const trial::TrialParameters p = trial_of(study, point, 0);
    const Cycle cycle = stick_slip_cycle(p);
    const trial::MoveOutcome move = trial::run_trial(p).moves.front();
    EXPECT_NEAR(move.oscillation_amplitude * loop::fine_resolution(p.encoder), cycle.amplitude,
                0.01 * cycle.amplitude)
        << point;
    EXPECT_NEAR(move.oscillation_period, cycle.period, 0.01 * cycle.period) << point;
  }
}

TEST(Deadband, ADeadbandOfOneCountCostsZeroCounts) {
  const study::Study study = shipped_study("deadband");
  EXPECT_TRUE(proportion_above(0.85, moves_at_zero("deadband", study.points.labels[0], 100), 100));
  EXPECT_TRUE(proportion_below(0.4, moves_at_zero("deadband", study.points.labels[4], 100), 100));
}

TEST(Observer, DoesNotBeatTheIntegralAndChatters) {
  EXPECT_TRUE(proportion_above(0.85, moves_at_zero("observer", "integral-kp", 150), 150));
  const auto chatters = [](const char* point) {
    return moves_with(outcomes_of(shipped_study("observer"), point, 60),
                      [](const trial::MoveOutcome& move) { return move.jerk_count > 20; });
  };
  EXPECT_TRUE(proportion_above(0.4, chatters("observer-50"), 60));
  EXPECT_TRUE(proportion_below(0.15, chatters("integral-kp"), 60));
}

TEST(Resonance, LimitsALoopWithTheEncoderAtTheLoad) {
  const study::Study study = shipped_study("resonance");
  const auto at = [&](std::size_t point) {
    return stable_moves("resonance", study.points.labels[point], 50);
  };
  EXPECT_TRUE(proportion_above(0.85, at(0), 50)) << "at the motor, however soft the coupling";
  EXPECT_TRUE(proportion_below(0.2, at(1), 50)) << "at the load, 52 Hz";
  EXPECT_TRUE(proportion_above(0.85, at(11), 50)) << "at the load, 221 Hz";
}

TEST(Notch, HelpsIfItIsWideEnough) {
  EXPECT_TRUE(proportion_below(0.75, stable_moves("notch", "none", 100), 100));
  EXPECT_TRUE(proportion_above(0.9, stable_moves("notch", "wide", 100), 100));
}

// air-bearing: without friction the loop hunts by one count wherever a torque acts that the converter cannot
// balance, as the paper says of such systems (section 1); on a ball bearing the spring holds the difference.

constexpr std::int64_t air_trials = 150;

std::int64_t moves_ending_in(const std::string& bearing, trial::Outcome outcome) {
  return moves_with(outcomes_of(shipped_study("air-bearing"), bearing, air_trials),
                    [outcome](const trial::MoveOutcome& move) { return move.outcome == outcome; });
}

TEST(AirBearing, HoldsZeroCountsOnlyWithoutADisturbance) {
  EXPECT_TRUE(proportion_above(0.95, moves_ending_in("air", trial::Outcome::zero_count), air_trials));
  EXPECT_TRUE(
      proportion_below(0.10, moves_ending_in("air-disturbed", trial::Outcome::zero_count), air_trials));
}

TEST(AirBearing, HuntsByOneCountUnderATorqueThatNoCodeBalances) {
  EXPECT_TRUE(
      proportion_above(0.90, moves_ending_in("air-disturbed", trial::Outcome::one_count), air_trials));
  EXPECT_TRUE(proportion_above(0.70, moves_ending_in("air-fine-dac", trial::Outcome::one_count), air_trials))
      << "nor does a fine converter help";
}

TEST(AirBearing, ABallBearingHoldsZeroCountsUnderTheSameDisturbance) {
  EXPECT_TRUE(proportion_above(0.86, moves_ending_in("ball", trial::Outcome::zero_count), air_trials));
}

// contact-variation: the loop holds zero counts whether its contacts are alike or not (paper, QN1 and QN2).

constexpr std::int64_t contact_trials = 60;

class Contacts : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(ContactVariation, Contacts, ::testing::Values("same", "varied"));

TEST_P(Contacts, EndTheirMovesInZeroCounts) {
  const auto outcomes = outcomes_of(shipped_study("contact-variation"), GetParam(), contact_trials);
  const std::int64_t moves = 6 * contact_trials;
  EXPECT_TRUE(
      proportion_above(0.97, moves_with(outcomes, [](const auto& move) { return move.stable; }), moves));
  EXPECT_TRUE(proportion_above(
      0.93, moves_with(outcomes, [](const auto& move) { return move.outcome == trial::Outcome::zero_count; }),
      moves));
  EXPECT_EQ(moves_with(outcomes, [](const auto& move) { return move.broke_away; }), moves)
      << "each move makes a new contact";
}

// encoder-noise and compensators: what noise leaves of zero counts, and what a dead zone of one count does.

constexpr std::int64_t machine_trials = 100;

TEST(EncoderNoise, HidesZeroCountsWhateverTheGains) {
  EXPECT_TRUE(
      proportion_below(0.45, moves_at_zero("encoder-noise", "x1-zero", machine_trials), machine_trials))
      << "an axis in the middle of its count shows 100 zeros in a row with a probability of 0.287";
}

TEST(EncoderNoise, LeavesOneCountAtTheResolutionOfThePaper) {
  const auto one_count = [](const auto& move) { return move.outcome == trial::Outcome::one_count; };
  const auto outcomes = outcomes_of(shipped_study("encoder-noise"), "x1", machine_trials);
  EXPECT_TRUE(proportion_above(0.5, moves_with(outcomes, one_count), machine_trials));
}

TEST(Compensators, AZoneOfOneCountLosesZeroCounts) {
  EXPECT_TRUE(proportion_above(0.8, moves_at_zero("compensators", "plain", machine_trials), machine_trials));
  EXPECT_TRUE(
      proportion_above(0.8, moves_at_zero("compensators", "standstill", machine_trials), machine_trials));
  EXPECT_TRUE(proportion_below(0.45, moves_at_zero("compensators", "integral-zone-1", machine_trials),
                               machine_trials));
}

}  // namespace
}  // namespace zerocount::testing
