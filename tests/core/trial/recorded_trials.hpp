#pragma once

#include "core/trial/trial.hpp"
#include "tests/core/trial/literal_trial.hpp"
#include "tests/core/trial/widened_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {

/// A simulated trial with everything that was recorded of it: parameters, samples and outcome.
struct RecordedTrial {
  std::string name;
  trial::TrialParameters parameters;
  std::vector<trial::SampleRecord> samples;
  std::vector<trial::Jerk> jerks;
  trial::TrialOutcome outcome;

  bool is_open() const { return !parameters.command.torque.levels.empty(); }
  bool is_exact() const { return is_open() && parameters.command.torque.through == trial::TorquePath::exact; }
};

/// Runs a random trial of a kind and records everything that it reports.
inline RecordedTrial record(WidenedKind kind, std::uint64_t index) {
  RecordedTrial trial;
  trial.name = "kind " + std::to_string(static_cast<int>(kind)) + " trial " + std::to_string(index);
  trial.parameters = widened_trial(kind, index);
  trial::TrialObservers observers;
  observers.sample = [&trial](const trial::SampleRecord& sample) { trial.samples.push_back(sample); };
  observers.jerk = [&trial](const trial::Jerk& jerk) { trial.jerks.push_back(jerk); };
  trial.outcome = trial::run_trial(trial.parameters, observers);
  return trial;
}

/// The random trials that the tests check: 32 with two phases, 16 with one, 16 open loop.
inline const std::vector<RecordedTrial>& recorded_trials() {
  static const std::vector<RecordedTrial> trials = [] {
    std::vector<RecordedTrial> all;
    for (std::uint64_t index = 0; index < 32; ++index) {
      all.push_back(record(WidenedKind::two_phases, index));
      if (index % 2 == 0) all.push_back(record(WidenedKind::one_phase, index));
      if (index % 2 == 0) all.push_back(record(WidenedKind::open_loop, index));
    }
    return all;
  }();
  return trials;
}

/// Calls `check` with each trial. Fails if a trial does not have all samples of its moves.
template <class Check>
void for_each_trial(Check check) {
  for (const RecordedTrial& trial : recorded_trials()) {
    SCOPED_TRACE(trial.name);
    const MoveSpan last = literal_spans(trial.parameters).back();
    ASSERT_EQ(trial.samples.size(), last.first + last.size);
    ASSERT_EQ(trial.outcome.moves.size(), literal_spans(trial.parameters).size());
    check(trial);
  }
}

/// Calls `check` with the index of each move of the trial and the range of its samples.
template <class Check>
void for_each_move(const RecordedTrial& trial, Check check) {
  const std::vector<MoveSpan> spans = literal_spans(trial.parameters);
  for (std::size_t move = 0; move < spans.size(); ++move) {
    SCOPED_TRACE(::testing::Message() << "move " << move);
    check(move, spans[move]);
  }
}

/// The torque (N m) of each sample before it is rounded to a code.
inline std::vector<long double> wanted_torques(const RecordedTrial& trial) {
  if (trial.is_open()) return literal_torques(trial.parameters);
  std::vector<long double> torques;
  for (const LiteralDecision& decision : literal_decisions(trial.parameters, trial.samples))
    torques.push_back(decision.torque);
  return torques;
}

}  // namespace zerocount::testing
