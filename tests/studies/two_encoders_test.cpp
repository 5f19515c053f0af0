// two-encoders: what one fault of the instruments does to zero counts, and whether the second encoder
// notices.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "tests/studies/proportion_bounds.hpp"
#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

/// Counts of the fine encoder from where the rotor truly is to the middle of the target's count.
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
  EXPECT_TRUE(share_above(0.94, stable, trials));
  EXPECT_TRUE(share_above(0.88, zero_counts, trials));
}

class WithEncoderFault : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(TwoEncoders, WithEncoderFault,
                         ::testing::Values("fine-eccentric", "fine-interpolation", "fine-noise",
                                           "fine-missed-counts", "coarse-missed-counts"));

TEST_P(WithEncoderFault, TheSecondEncoderNoticesInManyMoves) {
  const study::Study study = shipped_study("two-encoders");
  const std::int64_t trials = 100;
  const auto outcomes = outcomes_of(study, GetParam(), trials);
  EXPECT_TRUE(share_above(
      0.3, moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.encoder_disagreement > 0; }),
      trials));
  EXPECT_TRUE(share_above(
      0.93, moves_with(outcomes, [](const trial::MoveOutcome& move) { return move.stable; }), trials));
}

/// Whether two ideal encoders with this phase read such counts at one place: the ranges in which they do,
/// in revolutions, overlap by more than rounding.
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
      for (const trial::SampleRecord& sample : trial.samples) {
        impossible += !one_place_has_both(trial.parameters, sample.count, sample.coarse_count);
      }
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
  EXPECT_TRUE(share_above(0.90, held, trials));
  EXPECT_TRUE(share_above(0.90, astray, trials)) << "zero counts, and not there";
  // The rotor passes some counts to and fro besides, of which as many are lost one way as the other.
  const double probability = 1.0e-3;
  EXPECT_TRUE(share_above(0.93 * probability, lost, passed));
  EXPECT_TRUE(share_below(1.07 * probability, lost, passed));
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
TEST(TwoEncoders, NoiseCostsZeroCountsByItselfAndMissedCoarseCountsCostNothing) {
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
  EXPECT_TRUE(share_below(0.5, zero_counts, trials));
}

}  // namespace
}  // namespace zerocount::testing
