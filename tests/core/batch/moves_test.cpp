// Moves in the lanes: many of them, short ones, and how they are judged.
#include "tests/core/batch/expect_agreement.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class Choices {
 public:
  explicit Choices(std::uint64_t seed) : engine_(seed) {}
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::mt19937_64 engine_;
};

trial::TrialParameters with_targets(trial::TrialParameters p, Choices& choices) {
  p.command.targets.clear();
  const std::int64_t moves = choices.integer(2, 7);
  for (std::int64_t move = 0; move < moves; ++move) {
    const bool stay = move > 0 && choices.integer(0, 3) == 0;
    p.command.targets.push_back(stay ? p.command.targets.back() : choices.integer(-30, 30));
  }
  return p;
}

TEST(BatchMoves, FollowOneAnother) {
  Choices choices(1);
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 120; ++i) {
    const TrialKind kind = i % 3 == 0 ? TrialKind::ringing : TrialKind::calm;
    trials.push_back(with_targets(trial_for_lanes(kind, 70000 + i), choices));
    trials.back().command.hold = static_cast<double>(choices.integer(60, 600)) / 2000.0;
  }
  const BatchAgreement agreement = expect_agreement_in_lanes(trials, "several moves");
  EXPECT_GT(agreement.trials - agreement.slides, 50);
}

TEST(BatchMoves, MayBeOfOneSample) {
  Choices choices(2);
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 120; ++i) {
    trials.push_back(with_targets(trial_for_lanes(TrialKind::calm, 71000 + i), choices));
    trial::TrialParameters& p = trials.back();
    p.controller.sample_rate = 2000.0;
    p.command.hold = static_cast<double>(choices.integer(1, 12)) / 2000.0;
    p.verdict.dwell = static_cast<double>(choices.integer(1, 3)) / 2000.0;
    p.verdict.window = static_cast<double>(choices.integer(1, 3)) / 2000.0;
  }
  expect_agreement_in_lanes(trials, "short moves");
}

/// Dwell and window from one sample to the whole move, and moves that arrive where they begin.
TEST(BatchMoves, AreJudgedByAnyDwellAndWindow) {
  Choices choices(3);
  std::vector<trial::TrialParameters> trials;
  int arrived = 0, jerks = 0;
  for (std::uint64_t i = 0; i < 150; ++i) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 72000 + i));
    trial::TrialParameters& p = trials.back();
    p.controller.sample_rate = 2000.0;
    p.controller.ki = std::min(p.controller.ki, 3e-5);
    if (i % 3 == 0) p.command.targets.front() = 0;
    const std::int64_t samples = choices.integer(100, 2000);
    p.command.hold = static_cast<double>(samples) / 2000.0;
    p.verdict.dwell = static_cast<double>(choices.integer(1, i % 2 == 0 ? 10 : samples)) / 2000.0;
    p.verdict.window = static_cast<double>(choices.integer(1, i % 2 == 0 ? 10 : samples)) / 2000.0;
    for (const trial::MoveOutcome& move : trial::run_trial(p).moves) {
      arrived += move.arrived;
      jerks += move.jerk_count > 0;
    }
  }
  expect_agreement_in_lanes(trials, "dwell and window");
  EXPECT_GT(arrived, 50);
  EXPECT_GT(jerks, 30);
}

/// Jumps at rest go over thousands of samples; a move of more than a million is one of them.
TEST(BatchMoves, MayBeLong) {
  std::vector<trial::TrialParameters> trials;
  for (std::uint64_t i = 0; i < 4; ++i) {
    trials.push_back(trial_for_lanes(TrialKind::calm, 73000 + i));
    trials.back().controller.ki = 2e-5;
    trials.back().controller.sample_rate = 2000.0;
    trials.back().command.targets = {static_cast<std::int64_t>(5 + 5 * i)};
    trials.back().command.hold = 150.0;
  }
  expect_agreement_in_lanes(trials, "long moves");
}

}  // namespace
}  // namespace zerocount::testing
