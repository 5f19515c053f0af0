#include "analysis/acceptance/acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

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

/// [move] whether it meets the goal.
std::vector<bool> met_moves(const study::Goal& goal, const monitor::MoveLog& log, parameters::AxisKind axis) {
  const double latest = measures::latest({.within = goal.within});
  std::vector<bool> met;
  for (const double time : values_of(log, settling_measure_of(goal), axis)) met.push_back(time <= latest);
  for (const study::GoalLimit& limit : goal.limits) {
    const std::vector<double>& values = values_of(log, limit.measure, axis);
    for (std::size_t i = 0; i < met.size(); ++i) met[i] = met[i] && std::abs(values[i]) <= limit.largest;
  }
  return met;
}

void require_acceptable(const study::Study& study, const std::string& path) {
  if (study.worlds > 0)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: has worlds, each of which predicts something else; expected a study of what is "
                    "known of the machines",
                    path));
  if (study.rigs == 0)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: no trials share a machine, so that it does not tell machines from moves; expected "
                    "rigs: 50, or more",
                    path));
  for (const study::Goal& goal : study.goals)
    if (!goal.on.empty())
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: a goal is about some moves of a trial ('on'), and a log does not tell which "
                      "they are; expected goals on all moves",
                      path));
}

/// [goal] the moves of each machine of the study at the point.
std::vector<measures::MoveCounts> simulated_counts(const reading::AllTrialsFile& file, std::int64_t point) {
  const study::Study& study = file.study();
  const std::vector<measures::CountedGoal> goals = measures::counted_goals(study);
  std::vector<measures::MoveCounts> counts(goals.size());
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

Claim claim_of(const study::Goal& goal, const measures::MoveCounts& simulated,
               const std::vector<std::vector<bool>>& met_of_machines, std::uint64_t seed) {
  Claim claim{.goal = goal, .predicted = goal::judge_goal(goal, simulated, 1)};
  std::int64_t common = std::numeric_limits<std::int64_t>::max();
  for (const statistics::RigMoves& rig : simulated.rigs) common = std::min(common, rig.moves);
  for (const std::vector<bool>& met : met_of_machines) common = std::min(common, std::ssize(met));
  measures::MoveCounts measured;
  std::vector<std::int64_t> first_met;
  for (std::size_t i = 0; i < met_of_machines.size(); ++i) {
    const std::vector<bool>& met = met_of_machines[i];
    const auto all = std::ranges::count(met, true);
    measured.add_rig(i, 0, {.trials = std::ssize(met), .moves = std::ssize(met), .met = all});
    first_met.push_back(std::count(met.begin(), met.begin() + common, true));
  }
  claim.measured = goal::judge_goal(goal, measured, 1);
  claim.moves = measured.moves;
  claim.met = measured.met;
  claim.rate = bounded_rate(claim.met, claim.moves, goal.confidence);
  claim.agreement = agreement_of(first_met, common, simulated.rigs, seed);
  return claim;
}

}  // namespace

Status status_of(const Claim& claim, double significance) {
  const bool is_worse = claim.agreement.p <= significance && claim.agreement.is_lower;
  if (claim.rate.high < claim.goal.moves || is_worse) return Status::rejected;
  return claim.rate.low >= claim.goal.moves ? Status::accepted : Status::undecided;
}

Status status_of(const Acceptance& acceptance) {
  Status worst = Status::accepted;
  for (const Claim& claim : acceptance.claims) {
    const Status status = status_of(claim, acceptance.significance);
    if (status == Status::rejected) return status;
    if (status == Status::undecided) worst = status;
  }
  return worst;
}

Acceptance accept(const reading::AllTrialsFile& file, std::int64_t point,
                  std::span<const monitor::MoveLog> logs) {
  const study::Study& study = file.study();
  require_acceptable(study, file.path().string());
  Acceptance acceptance;
  for (const monitor::MoveLog& log : logs) {
    if (log.moves() == 0)
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}: has no moves; expected a row for each move of the machine", log.name()));
    acceptance.machines.push_back({.name = log.name(), .moves = log.moves()});
  }
  const std::vector<measures::MoveCounts> simulated = simulated_counts(file, point);
  for (std::size_t i = 0; i < study.goals.size(); ++i) {
    std::vector<std::vector<bool>> met;
    for (std::size_t machine = 0; machine < logs.size(); ++machine) {
      met.push_back(met_moves(study.goals[i], logs[machine], file.axis()));
      acceptance.machines[machine].met.push_back(std::ranges::count(met.back(), true));
    }
    acceptance.claims.push_back(claim_of(study.goals[i], simulated[i], met, study.seed));
    acceptance.simulated = std::ssize(simulated[i].rigs);
  }
  for (const study::Premise& premise : study.premises)
    if (premise.state == study::PremiseState::assumed) acceptance.assumed.emplace_back(premise.assumption);
  return acceptance;
}

}  // namespace zerocount::acceptance
