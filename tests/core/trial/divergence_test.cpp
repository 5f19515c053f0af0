// Early decision, by core/trial/measures.md: where a trial is ended, that it is the beginning of the trial
// that is not ended, and that the outcomes of the paper's loops stay what they are.
#include "core/trial/divergence.hpp"

#include <stop_token>

#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"
#include "tests/core/trial/literal_trial.hpp"
#include "tests/core/trial/recorded_trials.hpp"
#include "tests/core/trial/widened_trials.hpp"
#include "tests/support/random_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

TEST(Divergence, IsAnErrorThatExceedsTheFirstByMoreThanTheLimit) {
  const trial::VerdictParameters verdict{.stop = true, .limit = 100.0};
  for (const std::int64_t first : {0, 1, -1, 30, -30, 5000, -5000}) {
    for (const int sign : {1, -1}) {
      const std::int64_t most = std::abs(first) + 100;
      EXPECT_FALSE(trial::diverged(verdict, first, sign * most)) << first;
      EXPECT_TRUE(trial::diverged(verdict, first, sign * (most + 1))) << first;
    }
    EXPECT_FALSE(trial::diverged(verdict, first, first));
  }
  EXPECT_FALSE(trial::diverged({.stop = true, .limit = 100.5}, 0, 100));
  EXPECT_TRUE(trial::diverged({.stop = true, .limit = 100.5}, 0, 101));
}

TEST(Divergence, IsCheckedOnlyIfRequested) {
  EXPECT_FALSE(trial::diverged({.limit = 2.0}, 0, 1000000));
  EXPECT_FALSE(trial::VerdictParameters{}.stop);
}

/// Runs a trial and records everything that it reports.
RecordedTrial run_recorded(const trial::TrialParameters& parameters, const std::string& name = "") {
  RecordedTrial trial{name, parameters, {}, {}, {}};
  trial::TrialObservers observers;
  observers.sample = [&trial](const trial::SampleRecord& sample) { trial.samples.push_back(sample); };
  observers.jerk = [&trial](const trial::Jerk& jerk) { trial.jerks.push_back(jerk); };
  trial.outcome = trial::run_trial(parameters, observers);
  return trial;
}

auto fields(const trial::SampleRecord& r) {
  return std::tie(r.k, r.t, r.target, r.count, r.coarse_count, r.error, r.code, r.torque, r.theta, r.omega,
                  r.xp, r.xh, r.depth, r.mode, r.reference, r.phase, r.drive_torque);
}

auto fields(const trial::Jerk& jerk) {
  return std::tie(jerk.move, jerk.onset, jerk.duration, jerk.magnitude, jerk.direction);
}

/// The value, with NaN replaced by a number so that NaN compares equal to NaN.
double shown(double value) {
  return std::isnan(value) ? -1e300 : value;
}

/// All measures of a move except broke_away and reversal_depth, which can change after the last sample.
auto measures(const trial::MoveOutcome& m) {
  return std::tuple(m.outcome, m.arrived, m.stable, m.saturated, m.arrival, shown(m.arrival_time),
                    shown(m.final_settling_time), shown(m.zero_fraction), shown(m.travel_time), m.overshoot,
                    m.final_error, shown(m.true_error), shown(m.final_position), shown(m.holding_torque),
                    shown(m.peak_torque), shown(m.creep), m.phase_changes, m.encoder_disagreement,
                    m.jerk_count, shown(m.jerk_agreement));
}

/// The move and the sample at which the trial should end.
struct End {
  std::size_t move{0};
  std::size_t sample{0};  ///< index of the sample in the trial
};

/// The expected end of a trial, found from all samples of the same trial run to its end: the first sample
/// whose distance from the target exceeds that of the first sample of its move by more than the limit.
std::optional<End> end_of(const RecordedTrial& whole, double limit) {
  const std::vector<MoveSpan> spans = literal_spans(whole.parameters);
  for (std::size_t move = 0; move < spans.size(); ++move) {
    const auto distance = [&](std::size_t k) {
      return std::abs(static_cast<double>(whole.parameters.command.targets[move]) -
                      static_cast<double>(whole.samples[k].count));
    };
    for (std::size_t k = spans[move].first; k < spans[move].first + spans[move].size; ++k) {
      if (distance(k) - distance(spans[move].first) > limit) return End{move, k};
    }
  }
  return std::nullopt;
}

void expect_beginning_of(const RecordedTrial& whole, const RecordedTrial& ended, std::size_t samples) {
  ASSERT_EQ(ended.samples.size(), samples);
  for (std::size_t k = 0; k < samples; ++k)
    ASSERT_EQ(fields(ended.samples[k]), fields(whole.samples[k])) << "sample " << k;
  ASSERT_LE(ended.jerks.size(), whole.jerks.size());
  for (std::size_t i = 0; i + 1 < ended.jerks.size(); ++i)
    EXPECT_EQ(fields(ended.jerks[i]), fields(whole.jerks[i])) << "jerk " << i;
  if (ended.jerks.empty()) return;
  const trial::Jerk& last = ended.jerks.back();  // may be cut
  const trial::Jerk& same = whole.jerks[ended.jerks.size() - 1];
  EXPECT_EQ(last.move, same.move);
  EXPECT_EQ(last.onset, same.onset);
  EXPECT_EQ(last.direction, same.direction);
  EXPECT_LE(last.duration, same.duration);
  EXPECT_LE(last.magnitude, same.magnitude);
}

void expect_not_run(const trial::MoveOutcome& move) {
  EXPECT_TRUE(move.stopped);
  EXPECT_FALSE(trial::was_run(move));
  EXPECT_EQ(move.outcome, trial::Outcome::oscillating);
  EXPECT_FALSE(move.arrived || move.stable || move.broke_away || move.saturated);
  EXPECT_EQ(move.arrival, -1);
  for (const double real :
       {move.arrival_time, move.travel_time, move.true_error, move.final_position, move.holding_torque,
        move.peak_torque, move.creep, move.jerk_agreement, move.final_settling_time, move.zero_fraction,
        move.oscillation_amplitude, move.oscillation_period}) {
    EXPECT_TRUE(std::isnan(real));
  }
  for (const std::int64_t whole : {move.overshoot, move.final_error, move.reversal_depth, move.phase_changes,
                                   move.encoder_disagreement, move.jerk_count, move.midway_error}) {
    EXPECT_EQ(whole, 0);
  }
}

/// Expects that the move in which the trial was ended is measured like a complete move that ends there.
void expect_measured_to(const RecordedTrial& ended, const End& end) {
  const trial::MoveOutcome& move = ended.outcome.moves[end.move];
  EXPECT_TRUE(move.stopped && trial::was_run(move));
  EXPECT_EQ(move.outcome, trial::Outcome::oscillating);
  EXPECT_FALSE(move.stable);
  const trial::SampleRecord& last = ended.samples[end.sample];
  EXPECT_EQ(move.final_error, last.error);
  EXPECT_EQ(move.final_position, last.theta);
  EXPECT_EQ(move.holding_torque, last.torque);
  EXPECT_EQ(move.creep, last.xp);
  if (end.move > 0) return;
  trial::TrialParameters shorter = ended.parameters;
  shorter.verdict.stop = false;
  shorter.command.targets.resize(1);
  shorter.command.hold = static_cast<double>(end.sample + 1) / shorter.controller.sample_rate;
  const RecordedTrial cut = run_recorded(shorter);
  ASSERT_EQ(cut.samples.size(), ended.samples.size());
  trial::MoveOutcome other = cut.outcome.moves[0];
  other.outcome = trial::Outcome::oscillating;  // a move that diverges is no approach, however short it was
  EXPECT_EQ(measures(move), measures(other));
  EXPECT_TRUE(std::isnan(move.oscillation_amplitude) && std::isnan(move.oscillation_period));
  EXPECT_EQ(move.midway_error, 0);
  EXPECT_LE(move.broke_away, other.broke_away);
  EXPECT_LE(move.reversal_depth, other.reversal_depth);
  ASSERT_EQ(cut.jerks.size(), ended.jerks.size());
  for (std::size_t i = 0; i < cut.jerks.size(); ++i) EXPECT_EQ(fields(cut.jerks[i]), fields(ended.jerks[i]));
}

struct Seen {
  int trials{0}, ended{0}, later{0}, arrived{0}, moves_not_run{0};
};

void check(const RecordedTrial& whole, double limit, Seen& seen) {
  SCOPED_TRACE(whole.name + " limit " + std::to_string(limit));
  trial::TrialParameters parameters = whole.parameters;
  parameters.verdict.stop = true;
  parameters.verdict.limit = limit;
  const RecordedTrial ended = run_recorded(parameters);
  const std::optional<End> end = end_of(whole, limit);
  ++seen.trials;
  ASSERT_EQ(ended.outcome.moves.size(), whole.outcome.moves.size());
  expect_beginning_of(whole, ended, end ? end->sample + 1 : whole.samples.size());
  for (std::size_t m = 0; m < ended.outcome.moves.size(); ++m) {
    const trial::MoveOutcome& move = ended.outcome.moves[m];
    if (!end || m < end->move) {
      EXPECT_EQ(measures(move), measures(whole.outcome.moves[m])) << "move " << m;
      EXPECT_EQ(move.broke_away, whole.outcome.moves[m].broke_away);
      EXPECT_EQ(move.reversal_depth, whole.outcome.moves[m].reversal_depth);
      EXPECT_FALSE(move.stopped);
    } else if (m > end->move) {
      expect_not_run(move);
      ++seen.moves_not_run;
    }
  }
  if (!end) return;
  expect_measured_to(ended, *end);
  ++seen.ended;
  seen.later += end->move > 0;
  seen.arrived += ended.outcome.moves[end->move].arrived;
}

TEST(EarlyDecision, StopsATrialAtDivergenceAndChangesNothingBefore) {
  Seen seen;
  for (const TrialKind kind : {TrialKind::calm, TrialKind::ringing, TrialKind::breaking_away,
                               TrialKind::coulomb, TrialKind::amplified, TrialKind::arriving}) {
    for (std::uint64_t index = 0; index < 12; ++index) {
      const RecordedTrial whole =
          run_recorded(random_trial(kind, index),
                       "kind " + std::to_string(static_cast<int>(kind)) + " trial " + std::to_string(index));
      if (whole.outcome.moves.back().outcome == trial::Outcome::nonfinite) continue;
      for (const double limit : {2.0, 20.0, 300.0, 1000.0}) check(whole, limit, seen);
    }
  }
  for (std::uint64_t index = 100; index < 130; ++index) {  // that begin at their target and leave it
    trial::TrialParameters parameters = random_trial(TrialKind::ringing, index);
    parameters.command.targets.front() = 0;
    parameters.initial.integral = 0.1;
    parameters.verdict.dwell = 1.0 / parameters.controller.sample_rate;
    check(run_recorded(parameters, "arriving trial " + std::to_string(index)), 30.0, seen);
  }
  for (const RecordedTrial& whole : recorded_trials()) {
    if (whole.is_open()) continue;
    for (const double limit : {2.0, 300.0}) check(whole, limit, seen);
  }
  std::cout << seen.trials << " trials, " << seen.ended << " ended, of them " << seen.later
            << " after the first move and " << seen.arrived << " after arriving; " << seen.moves_not_run
            << " moves not run\n";
  EXPECT_GT(seen.ended, 50);
  EXPECT_GT(seen.trials - seen.ended, 50);
  EXPECT_GT(seen.later, 10);
  EXPECT_GT(seen.arrived, 5);
  EXPECT_GT(seen.moves_not_run, 20);
}

TEST(EarlyDecision, HasNoEffectOnAnOpenLoop) {
  for (std::uint64_t index = 0; index < 5; ++index) {
    trial::TrialParameters parameters = widened_trial(WidenedKind::open_loop, index);
    const RecordedTrial whole = run_recorded(parameters);
    parameters.verdict.stop = true;
    parameters.verdict.limit = 2.0;
    const RecordedTrial asked = run_recorded(parameters);
    expect_beginning_of(whole, asked, whole.samples.size());
    for (const trial::MoveOutcome& move : asked.outcome.moves) EXPECT_FALSE(move.stopped);
  }
}

// A request to stop ends a trial and a batch between two samples; a motion that takes steps without end is
// given up.

trial::TrialParameters long_trial() {
  trial::TrialParameters trial;
  trial.command.targets = {5};
  trial.command.hold = 1.0;
  return trial;
}

TEST(Interruption, StopsATrialAtTheNextSample) {
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

TEST(Interruption, StopsABatchAndLeavesTheEngineUsable) {
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
      EXPECT_EQ(outcome.moves.front().arrival_time, expected.moves.front().arrival_time);
      EXPECT_EQ(outcome.moves.front().final_error, expected.moves.front().final_error);
    }
  }
}

TEST(Interruption, StopsAContactThatCreepsWithoutEnd) {
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
