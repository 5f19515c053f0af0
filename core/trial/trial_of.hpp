#pragma once

#include "core/trial/divergence.hpp"
#include "core/trial/machine.hpp"
#include "core/trial/move_measures.hpp"
#include "core/trial/open_loop.hpp"
#include "core/trial/sampled_loop.hpp"
#include "core/trial/trial.hpp"
#include "core/trial/watched_trial.hpp"

/// Implementation of a trial as a template over its plant, which is PlantOf a list of friction laws.
namespace zerocount::trial {

/// Whether the friction contact slid during a move.
/// @param breakaway manner in which the law begins to slide.
/// @param at_start, at_instants whether it slid at the start of the move, and at any of its sampling
/// instants.
/// @param broke_away whether it broke away at any time during the move.
inline bool slid_in_move(friction::Breakaway breakaway, bool at_start, bool at_instants, bool broke_away) {
  switch (breakaway) {
    case friction::Breakaway::never:
      break;
    case friction::Breakaway::of_hook:
      return at_start || broke_away;
    case friction::Breakaway::gradual:
      return at_instants;
  }
  return false;
}

/// Runs the samples of one move. A move that diverges is ended.
/// @param first number of the move's first sample, counted from the start of the trial.
/// @param target target of the move, counts. If the reference never comes to rest, the move is measured as if
/// the reference stood at this target, with the same errors.
/// @param decide decide(i, record) completes the record of sample i of the move: target, reference and
/// torque.
template <class AnyPlant, class Decide>
MoveOutcome run_move(Machine<AnyPlant>& machine, const MoveTiming& timing, const VerdictParameters& verdict,
                     std::int64_t move, std::int64_t first, std::int64_t target,
                     const TrialObservers& observers, Decide decide) {
  MoveMeasures measures(timing, move);
  AnyPlant& plant = machine.plant();
  plant.forget_deepest();
  const std::int64_t breakaways_before = plant.breakaways();
  const std::int64_t disagreements_before = machine.measurement().disagreements();
  const bool sliding_before = plant.sliding();
  bool sliding_at_instants = false;
  std::int64_t first_error = 0;
  for (std::int64_t i = 0; i < timing.samples && machine.readable(); ++i) {
    if (observers.stop.stop_requested()) throw Interrupted{};
    SampleRecord record = machine.read(first + i);
    decide(i, record);
    sliding_at_instants = sliding_at_instants || record.mode == HookMode::slide;
    if (observers.sample) observers.sample(record);
    const bool jerk_ended = measures.add(
        {target, target - record.error, record.torque, machine.clipped(), record.theta, record.xp});
    if (jerk_ended && observers.jerk) observers.jerk(measures.last_jerk());
    if (i == 0) first_error = record.error;
    if (timing.judged && diverged(verdict, first_error, record.error)) {
      measures.stop();
      break;
    }
    machine.hold();
  }
  const bool slid = slid_in_move(plant.breakaway(), sliding_before, sliding_at_instants,
                                 plant.breakaways() > breakaways_before);
  const bool jerk_cut = measures.finish(slid, plant.deepest(), machine.readable());
  if (jerk_cut && observers.jerk) observers.jerk(measures.last_jerk());
  MoveOutcome outcome = measures.outcome();
  outcome.encoder_disagreement = machine.measurement().disagreements() - disagreements_before;
  return outcome;
}

/// Runs a closed-loop trial, in which the controller follows a reference to each target.
/// @throws Interrupted if `watch` ends the trial
template <class AnyPlant>
TrialOutcome follow_targets(const TrialParameters& p, const TrialObservers& observers,
                            const LoopWatch& watch = {}) {
  Machine<AnyPlant> machine(p);
  SampledLoop loop(p, machine.measurement());
  TrialOutcome outcome;
  std::int64_t first = 0;
  bool stopped = false;
  for (std::size_t m = 0; m < p.command.targets.size() && !stopped; ++m) {
    const MoveTiming timing = move_timing(p, m);
    const std::int64_t target = p.command.targets[m];
    std::int64_t last_target = target;
    loop.start_move(m);
    const auto decide = [&](std::int64_t i, SampleRecord& record) {
      const SampledLoop::Decision decision =
          loop.decide(record.k, i, machine.last_reading(), machine.last_measured(), machine.last_other());
      record.reference = decision.reference;
      record.target = last_target = decision.target;
      record.error = record.target - record.count;
      record.phase = loop.phase();
      machine.drive(decision.output, record);
      if (loop.failed()) machine.fail();
      if (watch && !watch({record, decision.wanted, machine.plant().steps()})) throw Interrupted{};
    };
    MoveOutcome move =
        run_move(machine, timing, p.verdict, static_cast<std::int64_t>(m), first, target, observers, decide);
    if (move.outcome != Outcome::nonfinite) {
      move.true_error = true_error(last_target, machine.last_measured(),
                                   machine.measurement().fine_resolution(), p.initial.encoder_phase);
    }
    loop.finish(move);
    outcome.moves.push_back(move);
    stopped = move.stopped;
    first += timing.samples;
  }
  while (outcome.moves.size() < p.command.targets.size())
    outcome.moves.push_back(move_not_run(outcome.moves.size()));
  return outcome;
}

/// Runs an open-loop trial, in which the torque goes from level to level, or follows a record.
template <class AnyPlant>
TrialOutcome apply_torques(const TrialParameters& p, const TrialObservers& observers) {
  Machine<AnyPlant> machine(p);
  OpenLoop loop(p);
  TrialOutcome outcome;
  std::int64_t first = 0;
  for (std::size_t m = 0; m < p.command.torque.levels.size(); ++m) {
    const MoveTiming timing = move_timing(p, m);
    loop.start_move(m);
    const auto decide = [&](std::int64_t i, SampleRecord& record) {
      record.error = -record.count;
      const OpenLoop::Decision decision = loop.decide(i);
      if (decision.exact) {
        machine.drive_exactly(decision.output.torque, record);
      } else {
        machine.drive(decision.output, record);
      }
    };
    MoveOutcome move =
        run_move(machine, timing, p.verdict, static_cast<std::int64_t>(m), first, 0, observers, decide);
    move.travel_time = loop.travel_time();
    outcome.moves.push_back(move);
    first += timing.samples;
  }
  return outcome;
}

/// Runs a trial as run_trial() does, but with a plant that may have other friction laws.
template <class AnyPlant>
TrialOutcome run_trial_of(const TrialParameters& parameters, const TrialObservers& observers = {}) {
  return parameters.command.torque.levels.empty() ? follow_targets<AnyPlant>(parameters, observers)
                                                  : apply_torques<AnyPlant>(parameters, observers);
}

}  // namespace zerocount::trial
