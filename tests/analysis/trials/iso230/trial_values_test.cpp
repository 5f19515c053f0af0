#include "analysis/trials/iso230/repeatability.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/support/test.hpp"

namespace zerocount::iso230 {
namespace {

constexpr double fine = 1620000.0;
constexpr double count = 2.0 * std::numbers::pi / fine;  // rad

/// The moves of a sequence with two targets and two cycles, each target approached from both sides.
std::vector<study::SequenceMove> two_targets() {
  std::vector<study::SequenceMove> moves;
  for (std::int64_t cycle = 0; cycle < 2; ++cycle) {
    for (const auto& [target, direction] : {std::pair{-1, -1}, {0, 1}, {1, 1}, {-1, 1}, {1, -1}, {0, -1}})
      moves.push_back({target, direction, cycle});
  }
  return moves;
}

trial::TrialParameters with_targets(double phase) {
  trial::TrialParameters parameters;
  parameters.encoder.fine = fine;
  parameters.initial.encoder_phase = phase;
  parameters.command.targets = {90, 100, 250, 260, 250, 100, 90, 100, 250, 260, 250, 100};
  return parameters;
}

/// The outcomes of moves that end `offsets` counts from the middle of their target's count.
std::vector<trial::MoveOutcome> ending_at(const trial::TrialParameters& parameters,
                                          const std::vector<double>& offsets) {
  std::vector<trial::MoveOutcome> moves(offsets.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const double middle = static_cast<double>(parameters.command.targets[i]) + 0.5;
    moves[i].outcome = trial::Outcome::zero_count;
    moves[i].final_position = (middle + offsets[i] - parameters.initial.encoder_phase) * count;
    moves[i].final_error = static_cast<std::int64_t>(std::floor(middle)) -
                           static_cast<std::int64_t>(std::floor(middle + offsets[i]));
  }
  return moves;
}

TEST(SequenceShape, IsCountedFromTheMoves) {
  const SequenceShape both = shape_of(two_targets());
  EXPECT_EQ(both.targets, 2);
  EXPECT_EQ(both.cycles, 2);
  EXPECT_TRUE(both.positive && both.negative);
  const SequenceShape one_side =
      shape_of(std::vector<study::SequenceMove>{{-1, 1, 0}, {2, -1, 0}, {1, -1, 0}, {0, -1, 0}});
  EXPECT_EQ(one_side.targets, 3);
  EXPECT_EQ(one_side.cycles, 1);
  EXPECT_FALSE(one_side.positive);
  EXPECT_TRUE(one_side.negative);
  EXPECT_EQ(shape_of({}).targets, 0);
}

TEST(TrialRepeatability, DeviationsAreFromTheMiddleOfTheTargetCount) {
  for (const double phase : {0.0, 0.3, 0.5, 0.999}) {
    const trial::TrialParameters parameters = with_targets(phase);
    // Target 0: from below 0.25 and 0.25, from above −0.25 and −1.75 (which reads −2 counts).
    const std::vector<double> offsets{9, 0.25, 0, 9, 0, -0.25, 9, 0.25, 0, 9, 0, -1.75};
    const auto result = trial_repeatability(two_targets(), parameters, ending_at(parameters, offsets));
    ASSERT_TRUE(result);
    const TargetRepeatability& truly = result->from_position.targets[0];
    EXPECT_NEAR(truly.mean_positive, 0.25 * count, 1e-9 * count);
    EXPECT_NEAR(truly.mean_negative, -1.0 * count, 1e-9 * count);
    EXPECT_NEAR(truly.repeatability_positive, 0.0, 1e-9 * count);
    EXPECT_NEAR(truly.repeatability_negative, 4.0 * 1.5 / std::sqrt(2.0) * count, 1e-9 * count);
    const TargetRepeatability& read = result->from_encoder.targets[0];
    EXPECT_EQ(read.mean_positive, 0.0);
    EXPECT_EQ(read.mean_negative, -1.0);
    EXPECT_EQ(read.repeatability_positive, 0.0);
    EXPECT_DOUBLE_EQ(read.repeatability_negative, 4.0 * std::sqrt(2.0));
    EXPECT_EQ(result->from_encoder.targets[1].repeatability, 0.0);
  }
}

// Each mass is measured by its own angle, from the middle of the target's count of the encoder that closes
// the loop.
TEST(TrialRepeatability, EachMassHasTheValuesOfASingleMassAxis) {
  std::mt19937_64 random(230);
  std::normal_distribution<double> normal(0.0, 3.0);
  for (const motion::EncoderPlace closing : {motion::EncoderPlace::motor, motion::EncoderPlace::load}) {
    trial::TrialParameters parameters = with_targets(0.25);
    std::vector<double> of_motor(12), of_load(12);
    for (double& offset : of_motor) offset = normal(random);
    for (double& offset : of_load) offset = normal(random);
    const auto alone = [&](const std::vector<double>& offsets) {
      return trial_repeatability(two_targets(), parameters, ending_at(parameters, offsets))->from_position;
    };
    const Repeatability motor_alone = alone(of_motor), load_alone = alone(of_load);
    std::vector<trial::MoveOutcome> moves = ending_at(parameters, of_motor);
    const bool load_closes = closing == motion::EncoderPlace::load;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      moves[i].true_error = -(load_closes ? of_load : of_motor)[i];
      if (!load_closes) moves[i].other_true_error = -of_load[i];
    }
    parameters.plant.load = {.inertia = 1e-4, .encoder = closing};
    const auto both = trial_repeatability(two_targets(), parameters, moves);
    const auto expect_same = [](const Repeatability& found, const Repeatability& expected) {
      EXPECT_NEAR(found.axis.reversal, expected.axis.reversal, 1e-9 * count);
      EXPECT_NEAR(found.axis.repeatability, expected.axis.repeatability, 1e-9 * count);
      EXPECT_NEAR(found.axis.accuracy, expected.axis.accuracy, 1e-9 * count);
      EXPECT_NEAR(found.targets[1].mean, expected.targets[1].mean, 1e-9 * count);
    };
    expect_same(both->of_motor, motor_alone);
    expect_same(both->of_load, load_alone);
    expect_same(both->from_position, load_closes ? load_alone : motor_alone);
  }
}

// Friction leaves the load at the side of the gap from which it was pushed: the reversal grows by the gap.
TEST(TrialRepeatability, ReversalOfALoadBehindAGapIncludesTheGap) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: gap\nseed: 1\ntrials: 1\n"
      "plant: {inertia: 1.0e-4, presliding_damping: 1.0e-3, load: {inertia: 1.0e-4, stiffness: 400, damping: "
      "5.0e-3, gap: 4.0e-3, damping_to_ground: 1.0e-3, encoder: motor, friction: {model: coulomb, breakaway: "
      "1.0e-3, coulomb_ratio: 1}}}\n"
      "friction: {model: none}\nencoder: {fine: 1000000}\ndac: {bits: 16, range: 2}\n"
      "controller: {sample_rate: 8000, units: si, kp: 4.0, ki: 0, kd: 0.03}\n"
      "command: {sequence: {targets: [-9000, 9000], overrun: 3000, cycles: 1, approach: bidirectional}, "
      "hold: "
      "1.0, profile: {shape: s_curve, velocity_limit: 0.5, acceleration_limit: 10, jerk_limit: 500}}\n",
      "test");
  const trial::TrialParameters parameters = study::study_trial(study, 0, 0).parameters;
  const auto found = trial_repeatability(study.sequence, parameters, trial::run_trial(parameters).moves);
  ASSERT_TRUE(found);
  for (std::size_t target = 0; target < 2; ++target) {
    const double motor = found->of_motor.targets[target].reversal;
    const double load = found->of_load.targets[target].reversal;
    EXPECT_NEAR(load, motor - 4.0e-3, 2.0e-5);  // friction twists the coupling by 2.5e-6 rad
  }
  EXPECT_EQ(found->from_position.axis.reversal, found->of_motor.axis.reversal);
}

TEST(TrialRepeatability, TargetsKeepTheOrderOfTheirList) {
  EXPECT_EQ(listed_targets(two_targets(), with_targets(0.5)), (std::vector<double>{100, 250}));
}

TEST(TrialRepeatability, UsesTheFinalPositionWhateverTheOutcome) {
  const trial::TrialParameters parameters = with_targets(0.5);
  std::vector<trial::MoveOutcome> moves = ending_at(parameters, std::vector<double>(12, 0.0));
  for (trial::MoveOutcome& move : moves) move.outcome = trial::Outcome::oscillating;
  EXPECT_TRUE(trial_repeatability(two_targets(), parameters, moves));
  moves[1].final_error = 40;
  EXPECT_EQ(trial_repeatability(two_targets(), parameters, moves)->from_encoder.targets[0].mean_positive,
            -20.0);
}

TEST(TrialRepeatability, IsEmptyIfTheMotionBecameNonfinite) {
  const trial::TrialParameters parameters = with_targets(0.5);
  const std::vector<trial::MoveOutcome> sound = ending_at(parameters, std::vector<double>(12, 0.0));
  for (std::size_t i = 0; i < sound.size(); ++i) {
    std::vector<trial::MoveOutcome> moves = sound;
    moves[i].outcome = trial::Outcome::nonfinite;
    EXPECT_FALSE(trial_repeatability(two_targets(), parameters, moves)) << i;
    moves = sound;
    moves[i].final_position = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(trial_repeatability(two_targets(), parameters, moves)) << i;
  }
}

TEST(TrialRepeatability, MovesThatDoNotMatchTheSequenceAreRefused) {
  trial::TrialParameters parameters = with_targets(0.5);
  const std::vector<trial::MoveOutcome> moves = ending_at(parameters, std::vector<double>(12, 0.0));
  EXPECT_THROW(trial_repeatability(two_targets(), parameters, std::span(moves).first(11)), Failure);
  parameters.command.targets.pop_back();
  EXPECT_THROW(trial_repeatability(two_targets(), parameters, moves), Failure);
}

}  // namespace
}  // namespace zerocount::iso230
