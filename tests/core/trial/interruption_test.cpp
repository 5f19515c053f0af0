// A request to stop ends a trial and a batch between two samples; a motion that takes steps without end is
// given up.
#include <stop_token>

#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

trial::TrialParameters long_trial() {
  trial::TrialParameters trial;
  trial.command.targets = {5};
  trial.command.hold = 1.0;
  return trial;
}

TEST(Interruption, EndsATrialAtTheNextSample) {
  std::stop_source source;
  std::int64_t samples = 0;
  trial::TrialObservers observers;
  observers.stop = source.get_token();
  observers.sample = [&](const trial::SampleRecord&) {
    if (++samples == 100) source.request_stop();
  };
  EXPECT_THROW(trial::run_trial(long_trial(), observers), trial::Interrupted);
  EXPECT_EQ(samples, 100);
}

TEST(Interruption, EndsABatchAndLeavesTheEngineAsItWas) {
  const trial::TrialParameters trial = long_trial();
  const std::vector<const trial::TrialParameters*> trials(300, &trial);
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  batch::BatchEngine engine;
  engine.run(trials, outcomes);
  const trial::TrialOutcome expected = outcomes.front();
  for (const std::int64_t after : {1, 1000, 100000}) {
    std::stop_source source;
    std::int64_t samples = 0;
    batch::BatchObservers observers;
    observers.stop = source.get_token();
    observers.sample = [&](const batch::BatchSample&) {
      if (++samples == after) source.request_stop();
    };
    EXPECT_THROW(engine.run(trials, outcomes, observers), trial::Interrupted);
    engine.run(trials, outcomes);
    for (const trial::TrialOutcome& outcome : outcomes) {
      EXPECT_EQ(outcome.moves.front().settling_time, expected.moves.front().settling_time);
      EXPECT_EQ(outcome.moves.front().final_error, expected.moves.front().final_error);
    }
  }
}

TEST(Interruption, AContactThatCreepsWithoutEndIsGivenUp) {
  trial::TrialParameters trial = long_trial();
  trial.friction.uniform.lambda = 1e-12;
  EXPECT_EQ(trial::run_trial(trial).moves.front().outcome, trial::Outcome::nonfinite);
  const std::vector<const trial::TrialParameters*> trials{&trial};
  std::vector<trial::TrialOutcome> outcomes(1);
  batch::BatchEngine().run(trials, outcomes);
  EXPECT_EQ(outcomes.front().moves.front().outcome, trial::Outcome::nonfinite);
}

}  // namespace
}  // namespace zerocount::testing
