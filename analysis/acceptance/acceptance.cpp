#include "analysis/acceptance/acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/measures/goal_counts.hpp"
#include "core/failure/failure.hpp"
#include "experiments/parameters/study_units.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::acceptance {
namespace {

constexpr std::int64_t trials_at_a_time = 4096;

/// The measure that says when a move is within the band, or the tolerance, of the goal for good.
std::string settling_measure_of(const study::Goal& goal) {
  return goal.tolerance ? layout::name_of_tolerance("tolerance_settling_time", *goal.tolerance)
                        : layout::name_of_band("band_settling_time", goal.band);
}

/// @param axis of the study
const std::vector<double>& values_of(const monitor::MoveLog& log, const std::string& measure,
                                     parameters::AxisKind axis) {
  const monitor::MoveLog::Column* const column = log.find(measure);
  if (column == nullptr)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: has no column {}, which the goal asks for", log.name(), measure));
  const std::string unit = parameters::unit_on(axis, column->measure.unit);
  if (!monitor::have_same_dimension(column->unit, unit))
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {} is in '{}', and in the study in '{}'; expected a unit of the same "
                              "dimension",
                              log.name(), measure, column->unit, unit));
  return column->values;
}

/// [row] whether the goal is about it.
/// @param moves of a trial
std::vector<bool> asked_rows(const study::Goal& goal, const monitor::MoveLog& log, std::int64_t moves) {
  if (goal.on.empty()) return std::vector<bool>(static_cast<std::size_t>(log.moves()), true);
  if (log.numbers().empty())
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: a goal is about some moves of a trial ('on'); expected a column 'move' with "
                    "the number of each in the sequence, from 0",
                    log.name()));
  std::vector<bool> asked;
  for (const std::int64_t number : log.numbers()) {
    if (number < 0 || number >= moves)
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}: row {}: its 'move' is not a number in the sequence; expected 0 to {}",
                                log.name(), asked.size() + 1, moves - 1));
    asked.push_back(std::ranges::find(goal.on, number) != goal.on.end());
  }
  return asked;
}

/// [move that the goal is about] whether it meets the goal.
std::vector<bool> met_moves(const study::Goal& goal, const monitor::MoveLog& log,
                            const reading::AllTrialsFile& file) {
  const double latest = measures::latest({.within = goal.within});
  const std::vector<bool> asked = asked_rows(goal, log, file.moves());
  const std::vector<double>& times = values_of(log, settling_measure_of(goal), file.axis());
  std::vector<const std::vector<double>*> limited;
  for (const study::GoalLimit& limit : goal.limits)
    limited.push_back(&values_of(log, limit.measure, file.axis()));
  std::vector<bool> met;
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!asked[row]) continue;
    bool all = times[row] <= latest;
    for (std::size_t i = 0; i < limited.size(); ++i)
      all = all && std::abs((*limited[i])[row]) <= goal.limits[i].largest;
    met.push_back(all);
  }
  if (met.empty())
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: has none of the moves that the goal is about; expected "
                              "{} in its column 'move'",
                              log.name(), fmt::join(goal.on, ", ")));
  return met;
}

void require_acceptable(const study::Study& study, const std::string& path) {
  if (study.rigs == 0)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: no trials share a machine, so that it does not tell machines from moves; expected "
                    "rigs: 50, or more",
                    path));
}

/// [goal] the moves of each machine of the study at the point.
std::vector<measures::MoveCounts> simulated_counts(const reading::AllTrialsFile& file, std::int64_t point) {
  const study::Study& study = file.study();
  const std::vector<measures::CountedGoal> goals = measures::counted_goals(study);
  std::vector<measures::MoveCounts> counts(goals.size());
  for (measures::MoveCounts& one : counts) one.tell_apart(study.worlds, 0);
  const auto of_trial = static_cast<std::size_t>(file.moves());
  const layout::RowRange rows = file.rows_of(point);
  for (std::int64_t first = 0; first < rows.count; first += trials_at_a_time) {
    const std::int64_t count = std::min(trials_at_a_time, rows.count - first);
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes({rows.first + first, count});
    for (std::int64_t i = 0; i < count; ++i)
      for (std::size_t goal = 0; goal < goals.size(); ++goal)
        measures::count_moves(counts[goal], goals[goal], first + i, study.rigs,
                              std::span(outcomes).subspan(static_cast<std::size_t>(i) * of_trial, of_trial));
  }
  return counts;
}

goal::BoundedProportion bounded_rate(std::int64_t met, std::int64_t moves, double confidence) {
  return {statistics::rate(met, moves), statistics::proportion_at_least(met, moves, confidence),
          statistics::proportion_at_most(met, moves, confidence)};
}

/// The first moves of the machines, beside the simulated ones.
Agreement agreement_with(const std::vector<std::vector<bool>>& met_of_machines,
                         const measures::MoveCounts& simulated, std::uint64_t seed) {
  std::int64_t common = std::numeric_limits<std::int64_t>::max();
  for (const statistics::RigMoves& rig : simulated.rigs) common = std::min(common, rig.moves);
  for (const std::vector<bool>& met : met_of_machines) common = std::min(common, std::ssize(met));
  std::vector<std::int64_t> first_met;
  for (const std::vector<bool>& met : met_of_machines)
    first_met.push_back(std::count(met.begin(), met.begin() + common, true));
  return agreement_of(first_met, common, simulated.rigs, seed);
}

/// The prediction of the world that the machines are most like, with the intervals of all worlds.
void compare_with_worlds(Claim& claim, const std::vector<measures::MoveCounts>& worlds,
                         const std::vector<std::vector<bool>>& met_of_machines, std::uint64_t seed,
                         double significance) {
  statistics::ConfidenceInterval all{1.0, 0.0};
  claim.like_worlds = 0;
  for (std::size_t world = 0; world < worlds.size(); ++world) {
    const Agreement one = agreement_with(met_of_machines, worlds[world], seed);
    all = {std::min(all.low, one.predicted.low), std::max(all.high, one.predicted.high)};
    if (one.p > significance) ++*claim.like_worlds;
    if (world > 0 && one.p <= claim.agreement.p) continue;
    claim.agreement = one;
    claim.predicted = goal::judge_goal(claim.goal, worlds[world], 1);
  }
  claim.agreement.predicted = all;
}

/// The goal for the measured machines alone. @param parts goals that must be met
goal::Status status_of_these(const study::Goal& goal, const measures::MoveCounts& measured,
                             std::size_t parts) {
  if (!goal.machines) {
    if (bounded_rate(measured.met, measured.moves, goal.confidence).low >= goal.moves)
      return goal::Status::met;
    const double confidence = statistics::confidence_of_each(goal.confidence, parts);
    const bool is_missed = bounded_rate(measured.met, measured.moves, confidence).high < goal.moves;
    return is_missed ? goal::Status::missed : goal::Status::undecided;
  }
  const std::size_t machines = measured.rigs.size();
  std::int64_t meeting = 0, missing = 0;
  for (const statistics::RigMoves& one : measured.rigs) {
    const auto bounds = [&](std::size_t statements) {
      return bounded_rate(one.met, one.moves, statistics::confidence_of_each(goal.confidence, statements));
    };
    meeting += bounds(machines).low >= goal.moves;
    missing += bounds(machines * parts).high < goal.moves;
  }
  const double wanted = *goal.machines * static_cast<double>(machines);
  if (static_cast<double>(meeting) >= wanted) return goal::Status::met;
  return static_cast<double>(std::ssize(measured.rigs) - missing) < wanted ? goal::Status::missed
                                                                           : goal::Status::undecided;
}

/// The moves of the machines, each a cluster. @param met_of_machines [machine, move]
measures::MoveCounts measured_counts(const std::vector<std::vector<bool>>& met_of_machines) {
  measures::MoveCounts measured;
  for (std::size_t i = 0; i < met_of_machines.size(); ++i) {
    const std::vector<bool>& met = met_of_machines[i];
    measured.add_rig(i, 0,
                     {.trials = std::ssize(met),
                      .moves = std::ssize(met),
                      .met = std::count(met.begin(), met.end(), true)});
  }
  return measured;
}

/// The prediction of a claim, and whether the machines agree with it.
void compare_with_prediction(Claim& claim, const measures::MoveCounts& simulated,
                             const std::vector<std::vector<bool>>& met_of_machines, std::uint64_t seed,
                             double significance) {
  const std::vector<measures::MoveCounts> worlds = measures::in_worlds(simulated);
  if (worlds.empty()) {
    claim.predicted = goal::judge_goal(claim.goal, simulated, 1);
    claim.agreement = agreement_with(met_of_machines, simulated, seed);
  } else {
    compare_with_worlds(claim, worlds, met_of_machines, seed, significance);
  }
  claim.is_below_prediction = claim.agreement.p <= significance && claim.agreement.is_lower;
}

/// The verdict on each goal, [goal], of the machines that are judged.
void judge(Acceptance& acceptance, std::span<const study::Goal> goals,
           std::span<const measures::MoveCounts> measured) {
  const goal::Verdict verdict = goal::judge_goals(goals, measured, 1);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    Claim& claim = acceptance.claims[i];
    claim.moves = measured[i].moves;
    claim.met = measured[i].met;
    claim.rate = bounded_rate(claim.met, claim.moves, goals[i].confidence);
    claim.measured = verdict.goals.empty() ? verdict : verdict.goals[i];
    claim.status = acceptance.judged == Judged::all_machines
                       ? claim.measured.status
                       : status_of_these(goals[i], measured[i], goals.size());
  }
  if (acceptance.judged == Judged::all_machines && verdict.status == goal::Status::undecided)
    acceptance.needed_machines = goal::needs_of(goals, measured, 1).rigs;
}

}  // namespace

Status status_of(const Claim& claim) {
  if (claim.status == goal::Status::missed || claim.is_below_prediction) return Status::rejected;
  return claim.status == goal::Status::met ? Status::accepted : Status::undecided;
}

Status status_of(const Acceptance& acceptance) {
  Status worst = Status::accepted;
  for (const Claim& claim : acceptance.claims) {
    const Status status = status_of(claim);
    if (status == Status::rejected) return status;
    if (status == Status::undecided) worst = status;
  }
  return worst;
}

Acceptance accept(const reading::AllTrialsFile& file, std::int64_t point,
                  std::span<const monitor::MoveLog> logs, Judged judged) {
  const study::Study& study = file.study();
  require_acceptable(study, file.path().string());
  Acceptance acceptance{.judged = judged};
  acceptance.significance /= static_cast<double>(study.goals.size());
  for (const monitor::MoveLog& log : logs) {
    if (log.moves() == 0)
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}: has no moves; expected a row for each move of the machine", log.name()));
    acceptance.machines.push_back({.name = log.name()});
  }
  const std::vector<measures::MoveCounts> simulated = simulated_counts(file, point);
  std::vector<measures::MoveCounts> measured;
  for (std::size_t i = 0; i < study.goals.size(); ++i) {
    std::vector<std::vector<bool>> met;
    for (std::size_t machine = 0; machine < logs.size(); ++machine) {
      met.push_back(met_moves(study.goals[i], logs[machine], file));
      acceptance.machines[machine].moves.push_back(std::ssize(met.back()));
      acceptance.machines[machine].met.push_back(std::ranges::count(met.back(), true));
    }
    measured.push_back(measured_counts(met));
    Claim& claim = acceptance.claims.emplace_back(Claim{.goal = study.goals[i]});
    compare_with_prediction(claim, simulated[i], met, study.seed, acceptance.significance);
    acceptance.simulated = std::ssize(simulated[i].rigs);
  }
  judge(acceptance, study.goals, measured);
  acceptance.worlds = study.worlds;
  acceptance.standard_values = standard_values(file, point, logs);
  for (const study::Premise& premise : study.premises)
    if (premise.state == study::PremiseState::assumed) acceptance.assumed.emplace_back(premise.assumption);
  return acceptance;
}

}  // namespace zerocount::acceptance
