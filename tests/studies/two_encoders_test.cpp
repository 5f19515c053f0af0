// two-encoders: what one fault of the instruments does to zero counts, and whether the second encoder
// notices.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "experiments/study/study.hpp"
#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"
#include "tests/support/stop_elements.hpp"

namespace zerocount::testing {
namespace {

/// Distance in fine counts from the true position of the rotor to the middle of the target's count.
double true_miss(const trial::TrialParameters& parameters, const trial::MoveOutcome& move) {
  const double resolution = 2.0 * std::numbers::pi / parameters.encoder.fine;
  const auto target = static_cast<double>(parameters.command.targets.back());
  return move.final_position / resolution + parameters.initial.encoder_phase - (target + 0.5);
}

class WithoutEncoderFault : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(TwoEncoders, WithoutEncoderFault,
                         ::testing::Values("ideal", "coarse-feedback", "dac-offset-and-bow", "dac-noise",
                                           "amplifier-300-Hz", "amplifier-100-Hz"));

TEST_P(WithoutEncoderFault, ZeroCountsAreTrueAndTheEncodersAgree) {
  const study::Study study = shipped_study("two-encoders");
  const std::int64_t trials = 120;
  std::int64_t stable = 0, zero_counts = 0;
  for (std::int64_t index = 0; index < trials; ++index) {
    const trial::TrialParameters parameters = trial_of(study, GetParam(), index);
    const trial::MoveOutcome move = trial::run_trial(parameters).moves[0];
    stable += move.stable;
    zero_counts += move.outcome == trial::Outcome::zero_count;
    EXPECT_EQ(move.encoder_disagreement, 0);
    EXPECT_LE(std::abs(true_miss(parameters, move) + static_cast<double>(move.final_error)), 0.5 + 1e-6);
  }
  EXPECT_TRUE(proportion_above(0.94, stable, trials));
  EXPECT_TRUE(proportion_above(0.88, zero_counts, trials));
}

class WithEncoderFault : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(TwoEncoders, WithEncoderFault,
                         ::testing::Values("fine-eccentric", "fine-interpolation", "fine-noise",
                                           "fine-missed-counts", "coarse-missed-counts"));

TEST_P(WithEncoderFault, TheSecondEncoderNoticesInManyMoves) {
  const study::Study study = shipped_study("two-encoders");
  const std::int64_t trials = 100;
  const auto outcomes = outcomes_of(study, GetParam(), trials);
  EXPECT_TRUE(proportion_above(
      0.3, moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.encoder_disagreement > 0; }),
      trials));
  EXPECT_TRUE(proportion_above(
      0.93, moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable; }), trials));
}

/// Whether two ideal encoders with this phase can read these counts at one position: the position ranges of
/// the counts, in revolutions, overlap by more than rounding.
bool one_place_has_both(const trial::TrialParameters& parameters, std::int64_t fine, std::int64_t coarse) {
  const auto edge = [&parameters](std::int64_t count, double per_revolution) {
    return (static_cast<double>(count) - parameters.initial.encoder_phase) / per_revolution;
  };
  const double low = std::max(edge(fine, parameters.encoder.fine), edge(coarse, parameters.encoder.coarse));
  const double high =
      std::min(edge(fine + 1, parameters.encoder.fine), edge(coarse + 1, parameters.encoder.coarse));
  return high - low > 1e-15;
}

TEST(TwoEncoders, DisagreementIsTheNumberOfImpossiblePairsOfCounts) {
  const study::Study study = shipped_study("two-encoders");
  for (const std::string& label : study.points.labels) {
    for (std::int64_t index = 0; index < 6; ++index) {
      const WatchedTrial trial = watched(trial_of(study, label, index));
      std::int64_t impossible = 0;
      for (const trial::SampleRecord& sample : trial.samples)
        impossible += !one_place_has_both(trial.parameters, sample.count, sample.coarse_count);
      EXPECT_EQ(trial.outcome.moves[0].encoder_disagreement, impossible) << label << " " << index;
    }
  }
}

// The loop holds zero counts of an encoder that has lost some. How many is the rotor's way times their
// probability.
TEST(TwoEncoders, MissedCountsAreMissingFromTheTruePosition) {
  const study::Study study = shipped_study("two-encoders");
  std::int64_t passed = 0, lost = 0, held = 0, astray = 0;
  const std::int64_t trials = 100;
  for (std::int64_t index = 0; index < trials; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "fine-missed-counts", index);
    const trial::MoveOutcome move = trial::run_trial(parameters).moves[0];
    const double target = static_cast<double>(parameters.command.targets[0]);
    held += move.final_error == 0;
    if (move.final_error != 0) continue;
    const double miss = true_miss(parameters, move);
    astray += std::abs(miss) > 0.5;
    EXPECT_GT(miss * target, -std::abs(target)) << "too far, never too short";
    lost += std::lround(std::abs(miss));
    passed += std::lround(std::abs(target) + std::abs(miss));
  }
  EXPECT_TRUE(proportion_above(0.90, held, trials));
  EXPECT_TRUE(proportion_above(0.90, astray, trials)) << "zero counts, and not there";
  // The rotor passes some counts to and fro besides, of which as many are lost one way as the other.
  const double probability = 1.0e-3;
  EXPECT_TRUE(proportion_above(0.93 * probability, lost, passed));
  EXPECT_TRUE(proportion_below(1.07 * probability, lost, passed));
}

// A fault that is fixed on the scale moves the true position by what it reads wrong there, less what it read
// at the start.
TEST(TwoEncoders, AnEccentricScaleIsFollowedToItsError) {
  const study::Study study = shipped_study("two-encoders");
  double largest = 0.0;
  std::int64_t seen = 0, unseen_small = 0;
  for (std::int64_t index = 0; index < 100; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "fine-eccentric", index);
    const trial::MoveOutcome move = trial::run_trial(parameters).moves[0];
    if (move.final_error != 0) continue;
    const loop::EncoderErrors& errors = parameters.encoder.fine_errors;
    const double resolution = 2.0 * std::numbers::pi / parameters.encoder.fine;
    const double start = parameters.initial.position - errors.eccentricity_angle;
    const double read_too_far =
        errors.eccentricity * (std::sin(start + move.final_position) - std::sin(start)) / resolution;
    EXPECT_NEAR(true_miss(parameters, move), -read_too_far, 0.5 + 1e-6) << index;
    largest = std::max(largest, std::abs(read_too_far));
    // An error of more than a coarse count and a fine one cannot escape the coarse encoder.
    const double coarse_count = parameters.encoder.fine / parameters.encoder.coarse;
    if (std::abs(read_too_far) > coarse_count + 1.0) {
      ++seen;
      EXPECT_GT(move.encoder_disagreement, 0) << index;
    } else {
      ++unseen_small;
    }
  }
  EXPECT_GT(largest, 20.0) << "counts";
  EXPECT_GE(seen, 5);
  EXPECT_GE(unseen_small, 5);
}

// A reading that trembles by a fifth of a count is at zero at every sample only by chance, even though the
// rotor is there.
TEST(TwoEncoders, NoiseCostsZeroCountsButMissedCoarseCountsDoNot) {
  const study::Study study = shipped_study("two-encoders");
  const std::int64_t trials = 100;
  std::int64_t zero_counts = 0;
  for (std::int64_t index = 0; index < trials; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "fine-noise", index);
    const trial::MoveOutcome move = trial::run_trial(parameters).moves[0];
    zero_counts += move.outcome == trial::Outcome::zero_count;
    EXPECT_LE(std::abs(true_miss(parameters, move)), 1.5) << "true all the same";
    const trial::MoveOutcome ideal = trial::run_trial(trial_of(study, "ideal", index)).moves[0];
    const trial::MoveOutcome coarse =
        trial::run_trial(trial_of(study, "coarse-missed-counts", index)).moves[0];
    EXPECT_EQ(coarse.final_position, ideal.final_position) << "the coarse encoder only watches";
  }
  EXPECT_TRUE(proportion_below(0.5, zero_counts, trials));
}

// coarse-to-fine: two-phase control ends moves of degrees in zero counts; the fine gains alone destabilise
// sliding (paper, practical issue 2), and without an integral the rotor stalls away from its target (paper,
// section 2).

/// The samples of the last `duration` (s) of a trial.
std::vector<trial::SampleRecord> last_part(const WatchedTrial& trial, double duration) {
  const auto samples = trial::samples_in(duration, trial.parameters.controller.sample_rate);
  return {trial.samples.end() - samples, trial.samples.end()};
}

std::int64_t sign_changes_of_error(const std::vector<trial::SampleRecord>& samples) {
  std::int64_t changes = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) changes += samples[k].error * samples[k - 1].error < 0;
  return changes;
}

TEST(CoarseToFine, TwoPhaseControlEndsItsMovesInZeroCounts) {
  const study::Study study = shipped_study("coarse-to-fine");
  const std::int64_t trials = 160;
  const auto outcomes = outcomes_of(study, "two-phase", trials);
  EXPECT_TRUE(proportion_above(
      0.95, moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable; }), trials));
  EXPECT_TRUE(proportion_above(
      0.90,
      moves_with(outcomes,
                 [](const trial::MoveOutcome& move) { return move.outcome == trial::Outcome::zero_count; }),
      trials));
  for (const trial::TrialOutcome& outcome : outcomes) {
    const trial::MoveOutcome& move = outcome.moves[0];
    EXPECT_TRUE(move.broke_away) << "the way is degrees long, the pre-sliding range is not";
    EXPECT_GE(move.phase_changes, 2) << "to the coarse phase as it sets out, and back";
  }
}

TEST(CoarseToFine, TwoPhaseMovesMissZeroCountsOnlyByAJerk) {
  const study::Study study = shipped_study("coarse-to-fine");
  int missed = 0;
  for (std::int64_t index = 0; index < study.trials && missed < 3; ++index) {
    const trial::TrialParameters parameters = trial_of(study, "two-phase", index);
    if (trial::run_trial(parameters).moves[0].outcome == trial::Outcome::zero_count) continue;
    ++missed;
    const WatchedTrial trial = watched(parameters);
    ASSERT_FALSE(trial.jerks.empty());
    const trial::Jerk& last = trial.jerks.back();
    EXPECT_EQ(last.magnitude, 1);
    EXPECT_GT(last.onset + last.duration, parameters.command.hold - parameters.verdict.window);
    EXPECT_EQ(last.direction, trial.outcome.moves[0].holding_torque > 0.0 ? 1 : -1) << "creep's own";
  }
  EXPECT_EQ(missed, 3) << "otherwise nothing was looked at";
}

TEST(CoarseToFine, FineGainsAreUnstableWhileSliding) {
  const study::Study study = shipped_study("coarse-to-fine");
  const std::int64_t trials = 100;
  std::int64_t stable = 0;
  for (std::int64_t index = 0; index < trials; ++index) {
    const WatchedTrial trial = watched(trial_of(study, "fine-alone", index));
    stable += trial.outcome.moves[0].stable;
    const std::vector<trial::SampleRecord> end = last_part(trial, 1.0);
    EXPECT_GE(sign_changes_of_error(end), 20) << index;
    std::int64_t sliding = 0, farthest = 0;
    for (const trial::SampleRecord& sample : end) {
      sliding += sample.mode == trial::HookMode::slide;
      farthest = std::max(farthest, std::abs(sample.error));
    }
    EXPECT_GT(sliding, 1000) << "of 2000 samples";
    EXPECT_GT(farthest, 1000) << "counts";
    const loop::DacParameters& dac = trial.parameters.dac;
    const double largest = (std::pow(2.0, dac.bits - 1) - 1.0) * dac.resolution;
    EXPECT_GE(trial.outcome.moves[0].peak_torque, largest) << "what bounds it is the converter";
  }
  EXPECT_TRUE(proportion_below(0.07, stable, trials));
}

TEST(CoarseToFine, FineGainsAreStableIfNothingSlides) {
  const study::Study study = shipped_study(
      "coarse-to-fine", {"command.targets.0={integers: [1, 30]}", "command.profile={shape: step}"});
  const std::int64_t trials = 100;
  const auto outcomes = outcomes_of(study, "fine-alone", trials);
  EXPECT_TRUE(proportion_above(
      0.93,
      moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable && !move.broke_away; }),
      trials));
}

class WithoutIntegral : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(CoarseToFine, WithoutIntegral, ::testing::Values("p-alone", "pd-alone"));

TEST_P(WithoutIntegral, TheRotorStallsAwayFromItsTarget) {
  const study::Study study = shipped_study("coarse-to-fine");
  const std::int64_t trials = 200;
  std::int64_t zero_counts = 0, near = 0;
  for (std::int64_t index = 0; index < trials; ++index) {
    const WatchedTrial trial = watched(trial_of(study, GetParam(), index));
    const trial::MoveOutcome& move = trial.outcome.moves[0];
    zero_counts += move.outcome == trial::Outcome::zero_count;
    near += std::abs(move.final_error) <= 5;
    // It has stopped, and what moves it still is creep: to one side, and less and less.
    const std::vector<trial::SampleRecord> end = last_part(trial, 2.0);
    EXPECT_EQ(sign_changes_of_error(end), 0) << index;
    for (const trial::SampleRecord& sample : end) ASSERT_EQ(sample.mode, trial::HookMode::stick) << index;
    const auto drift = [&end](std::size_t from, std::size_t to) {
      return std::abs(end[to].theta - end[from].theta);
    };
    EXPECT_LT(drift(2000, 3999), drift(0, 1999) + 2.0 * 3.9e-6) << index;
    const auto [low, high] = std::minmax_element(
        end.end() - 100, end.end(), [](const auto& a, const auto& b) { return a.error < b.error; });
    EXPECT_LE(high->error - low->error, 1) << index;
  }
  EXPECT_TRUE(proportion_below(0.06, zero_counts, trials));
  EXPECT_TRUE(proportion_below(0.15, near, trials));
}

// Without creep the rotor comes to rest altogether, but where it balances at the very edge of a count. The
// spring's torque at rest, by stop elements that follow the recorded elongation from the virgin contact, is
// what is left of the control's: kp·e. At zero error that would be 0, and a spring that has been stretched to
// the target is not without torque there.
TEST(CoarseToFine, ProportionalControlStopsWhereTheSpringBalancesIt) {
  const study::Study study =
      shipped_study("coarse-to-fine", {"command.targets.0={integers: [10, 60]}", "friction.alpha=0",
                                       "command.profile={shape: step}", "command.hold=1"});
  int resting = 0;
  for (std::int64_t index = 0; index < 60; ++index) {
    const WatchedTrial trial = watched(trial_of(study, "p-alone", index));
    const trial::TrialParameters& parameters = trial.parameters;
    ASSERT_FALSE(trial.outcome.moves[0].broke_away);
    EXPECT_GT(trial.samples.back().error, 0) << "without one, nothing would hold the spring";
    const trial::SampleRecord& end = trial.samples.back();
    if (std::abs(end.omega) > 1e-9) continue;
    ++resting;
    StopElements spring(friction::friction_at(parameters.friction, parameters.initial.position), 3000);
    for (const trial::SampleRecord& sample : trial.samples) spring.move_to(sample.theta);
    const double control = parameters.controller.kp * static_cast<double>(end.error);
    EXPECT_NEAR(spring.torque(), control, 0.5 * parameters.dac.resolution + 5e-5) << index;
  }
  EXPECT_GE(resting, 20);
}

// Practical issue 5: a count that comes or goes is a rate of one count per sample to a difference, and the
// torque that the derivative then asks for moves the rotor by many counts.
TEST(CoarseToFine, DifferencesOfTheCountKickTheRotorAtRest) {
  const study::Study study = shipped_study("coarse-to-fine");
  std::int64_t kicked = 0;
  const std::int64_t trials = 40;
  for (std::int64_t index = 0; index < trials; ++index) {
    const WatchedTrial trial = watched(trial_of(study, "pd-alone", index));
    const std::vector<trial::SampleRecord> end = last_part(trial, 2.0);
    const auto [low, high] = std::minmax_element(
        end.begin(), end.end(), [](const auto& a, const auto& b) { return a.torque < b.torque; });
    kicked += high->torque - low->torque > 0.9 * trial.parameters.controller.kd;
  }
  EXPECT_TRUE(proportion_above(0.5, kicked, trials));
  const trial::TrialParameters parameters = trial_of(study, "pd-alone", 0);
  const double count_stiffness = 110.0 * 2.0 * 3.141592653589793 / parameters.encoder.fine;  // N m/count
  EXPECT_GT(parameters.controller.kd, 10.0 * count_stiffness);
}

}  // namespace
}  // namespace zerocount::testing
