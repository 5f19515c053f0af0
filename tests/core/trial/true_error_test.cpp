// Where the rotor ended, against what the encoder says of it.
#include "core/loop/encoder.hpp"
#include "core/trial/trial.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// A trial, and the last sample of each of its moves.
struct EndedTrial {
  trial::TrialOutcome outcome;
  std::vector<trial::SampleRecord> ends;
};

EndedTrial run(const trial::TrialParameters& parameters) {
  std::vector<std::int64_t> last;
  std::int64_t samples = 0;
  for (std::size_t move = 0; move < trial::move_count(parameters); ++move) {
    samples += trial::samples_of_move(parameters, move);
    last.push_back(samples - 1);
  }
  EndedTrial trial;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& record) {
    if (record.k == last[trial.ends.size()]) trial.ends.push_back(record);
  };
  trial.outcome = trial::run_trial(parameters, observers);
  return trial;
}

std::int64_t ideal_count(const trial::TrialParameters& p, double theta) {
  return loop::read_count(loop::fine_encoder(p.encoder, p.initial.encoder_phase), theta);
}

/// Expects that by the true errors the rotor ended within the counts that an ideal encoder shows, and at the
/// place in them where it was.
void expect_places_of_rotor(const trial::TrialParameters& p, const EndedTrial& trial) {
  ASSERT_EQ(trial.ends.size(), trial.outcome.moves.size());
  const double resolution = 2.0 * std::numbers::pi / p.encoder.fine;
  for (std::size_t i = 0; i < trial.ends.size(); ++i) {
    const trial::SampleRecord& end = trial.ends[i];
    const double error = trial.outcome.moves[i].true_error;
    const double rounding = 1e-12 * (1.0 + std::abs(end.theta / resolution));
    const auto beyond = static_cast<double>(ideal_count(p, end.theta) - end.target);
    EXPECT_GT(error + beyond, -0.5 - rounding);
    EXPECT_LE(error + beyond, 0.5 + rounding);
    const double middle = (static_cast<double>(end.target) + 0.5 - p.initial.encoder_phase) * resolution;
    EXPECT_NEAR(error, (middle - end.theta) / resolution, rounding);
  }
}

/// Steps of 30 counts, back at last, that the loop holds at zero error; hardened, so that no creep disturbs
/// it.
trial::TrialParameters small_steps(std::uint64_t trial) {
  trial::TrialParameters p;
  p.command = {{30, 60, 90, 60}, 0.4};
  p.initial.hardening = 1e-3;
  p.initial.encoder_phase = std::fmod(0.05 + 0.31 * static_cast<double>(trial), 1.0);
  p.initial.position = 0.7 * static_cast<double>(trial);
  p.randomness.trial = trial;
  p.randomness.fine_missed = {3, 4};
  p.randomness.fine_noise = {5, 6};
  return p;
}

TEST(TrueError, OfIdealEncodersIsWithinHalfACountOfTheFinalError) {
  std::int64_t zero = 0;
  std::int64_t others = 0;
  for (const TrialKind kind : {TrialKind::calm, TrialKind::ringing, TrialKind::breaking_away,
                               TrialKind::unlike_the_paper, TrialKind::spring_alone, TrialKind::coulomb,
                               TrialKind::amplified, TrialKind::arriving, TrialKind::remembering}) {
    for (std::uint64_t index = 3000; index < 3030; ++index) {
      SCOPED_TRACE(::testing::Message() << "kind " << static_cast<int>(kind) << " trial " << index);
      const trial::TrialParameters p = random_trial(kind, index);
      const EndedTrial trial = run(p);
      expect_places_of_rotor(p, trial);
      for (const trial::MoveOutcome& move : trial.outcome.moves) {
        EXPECT_NEAR(move.true_error, static_cast<double>(move.final_error), 0.5 + 1e-9);
        EXPECT_EQ(move.final_error == 0, move.true_error > -0.5 && move.true_error <= 0.5);
        ++(move.final_error == 0 ? zero : others);
      }
    }
  }
  EXPECT_GT(zero, 100);
  EXPECT_GT(others, 100);
}

TEST(TrueError, IsOfTheRotorUnderEveryErrorOfItsEncoder) {
  for (std::uint64_t index = 0; index < 60; ++index) {
    SCOPED_TRACE(index);
    trial::TrialParameters p = random_trial(static_cast<TrialKind>(index % 3), 4000 + index);
    p.randomness = small_steps(index).randomness;
    p.encoder.fine_errors = {.eccentricity = 1e-3 * static_cast<double>(index % 4),
                             .interpolation = 0.3 * static_cast<double>(index % 5),
                             .noise = 0.5 * static_cast<double>(index % 7),
                             .missed = 0.05 * static_cast<double>(index % 6)};
    expect_places_of_rotor(p, run(p));
  }
}

TEST(TrueError, IsNoneWithoutATarget) {
  trial::TrialParameters p;
  p.command.torque.levels = {0.05, 0.0};
  p.command.hold = 0.1;
  for (const trial::MoveOutcome& move : trial::run_trial(p).moves) {
    EXPECT_EQ(move.outcome, trial::Outcome::open_loop);
    EXPECT_TRUE(std::isnan(move.true_error));
  }
}

TEST(TrueError, IsNoneWhereTheMotionWasLost) {
  trial::TrialParameters p = small_steps(0);
  p.initial.mode = trial::InitialMode::slide;
  p.initial.velocity = 1e18;
  for (const trial::MoveOutcome& move : trial::run_trial(p).moves) {
    EXPECT_EQ(move.outcome, trial::Outcome::nonfinite);
    EXPECT_TRUE(std::isnan(move.true_error));
  }
}

}  // namespace
}  // namespace zerocount::testing
