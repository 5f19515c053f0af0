#include "analysis/machine/acceptance/acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/clusters/observed_test.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/iso230/columns.hpp"
#include "analysis/trials/iso230/repeatability.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/failure/failure.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/parameters/study_units.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::acceptance {
namespace {

/// [machine][move] Whether the move of a measured machine meets a goal. Only the moves that the goal judges
/// are counted.
using MetMoves = std::vector<std::vector<bool>>;

/// Values of a measure in the log of a measured machine, one per move, in the unit of the study.
/// @param log log that has a column for the measure
/// @param axis kind of the axis of the study
/// @throws Failure (bad_input) if the unit in the log has another dimension
const std::vector<double>& values_of(const monitor::MoveLog& log, const std::string& measure,
                                     parameters::AxisKind axis) {
  const monitor::Moves::Column* const column = log.find(measure);  // require_columns()
  const std::string unit = parameters::unit_on(axis, column->measure.unit);
  if (!monitor::have_same_dimension(column->unit, unit))
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {} is in '{}', and in the study in '{}'; expected a unit of the same "
                              "dimension",
                              log.name, measure, column->unit, unit));
  return column->values;
}

/// Names of the measures that a log must contain so that the goal can be judged for each of its moves.
std::vector<std::string> measures_of(const study::Goal& goal) {
  std::vector<std::string> names{goal::name_of_settling(goal)};
  if (goal.within.after_profile) names.emplace_back("travel_time");
  for (const study::GoalLimit& limit : goal.limits) names.push_back(study::name_in(goal, limit.measure));
  return names;
}

/// Text for a message: the name of a measure that the log lacks, with the column of the log that resembles
/// the name, if there is one.
std::string missing_text(const monitor::MoveLog& log, const std::string& measure) {
  const std::optional<std::string> near = monitor::resembling_column(measure, log.other_columns);
  return near ? fmt::format("{} (its column '{}' looks like it)", measure, text::printable(*near)) : measure;
}

void require_columns(const std::vector<study::Goal>& goals, const monitor::MoveLog& log) {
  std::set<std::string> missing;
  for (const study::Goal& goal : goals)
    for (const std::string& name : measures_of(goal))
      if (log.find(name) == nullptr) missing.insert(missing_text(log, name));
  if (!missing.empty())
    throw Failure(ExitCode::bad_input, fmt::format("{}: has no column {}, which the goal asks for", log.name,
                                                   fmt::join(missing, ", ")));
}

/// Whether the goal judges the move in this row of the log. True for each row if the goal judges all moves of
/// a trial.
/// @param moves number of moves of a trial of the study
/// @throws Failure if the goal judges only some moves, and the log does not number its moves (bad_input) or
/// the number in this row is not one of a trial's moves (bad_data)
bool is_asked(const study::Goal& goal, const monitor::MoveLog& log, std::size_t row, std::int64_t moves) {
  if (goal.on.empty()) return true;
  if (!log.labels.numbered)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: a goal is about some moves of a trial ('on'); expected a column 'move' with "
                    "the number of each in the sequence, from 0",
                    log.name));
  const std::int64_t number = log.labels.of(row).number.value_or(-1);
  if (number < 0 || number >= moves)
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: row {}: its 'move' is not a number in the sequence; expected 0 to {}",
                              log.name, row + 1, moves - 1));
  return std::ranges::find(goal.on, number) != goal.on.end();
}

/// A limit of a goal on a measure, with the values of this measure in a log.
struct LoggedLimit {
  const monitor::MonitoredMeasure& measure;
  const std::vector<double>& values;  ///< [row] Value of the measure for the move in this row of the log.
  text::Limit limit;                  ///< Limit of the magnitude.
};

bool meets(const LoggedLimit& limit, std::size_t row) {
  const double value = limit.values[row];
  return monitor::is_nothing(limit.measure, value) || text::keeps(std::abs(value), limit.limit);
}

/// [move] Whether the move of the log meets the goal. Only the moves that the goal judges are contained, in
/// the order of the log.
/// @throws Failure (bad_data) if the log has none of these moves
std::vector<bool> met_moves(const study::Goal& goal, const monitor::MoveLog& log,
                            const reading::AllTrialsFile& file) {
  std::vector<bool> asked;
  for (std::size_t row = 0; row < static_cast<std::size_t>(log.moves); ++row)
    asked.push_back(is_asked(goal, log, row, file.moves()));
  const std::vector<double>& times = values_of(log, goal::name_of_settling(goal), file.axis());
  // Without profiles' ends that the goal counts from no log needs them.
  const std::vector<double> travels = goal.within.after_profile ? values_of(log, "travel_time", file.axis())
                                                                : std::vector<double>(times.size(), 0.0);
  std::vector<LoggedLimit> limits;
  for (const study::GoalLimit& limit : goal.limits) {
    const std::string name = study::name_in(goal, limit.measure);
    limits.push_back({log.find(name)->measure, values_of(log, name, file.axis()), limit.limit});
  }
  std::vector<bool> met;
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!asked[row]) continue;
    bool all = measures::is_in_time(times[row], goal.within.from_start(travels[row]));
    for (const LoggedLimit& limit : limits) all = all && meets(limit, row);
    met.push_back(all);
  }
  if (met.empty())
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: has none of the moves that the goal is about; expected "
                              "{} in its column 'move'",
                              log.name, fmt::join(goal.on, ", ")));
  return met;
}

/// [goal] Numbers of moves of each simulated machine at the design point: moves that the goal judges, and
/// moves that meet the goal.
std::vector<measures::CellCounts> simulated_counts(const reading::AllTrialsFile& file, std::int64_t point) {
  const study::Study& study = file.study();
  const std::vector<measures::MoveCriterion> goals = measures::criteria_of_goals(study);
  std::vector<measures::CellCounts> counts(goals.size(),
                                           measures::CellCounts({study.machines, study.worlds, 0}));
  const layout::RowRange rows = file.rows_of(point);
  measures::visit_trials(file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
    for (std::size_t goal = 0; goal < goals.size(); ++goal)
      measures::count_moves(counts[goal], goals[goal], row - rows.first, moves);
  });
  return counts;
}

goal::BoundedProportion bounded_rate(std::int64_t met, std::int64_t moves, double confidence) {
  return {statistics::rate(met, moves), statistics::proportion_at_least(met, moves, confidence),
          statistics::proportion_at_most(met, moves, confidence)};
}

/// Compares the measured machines with the simulated machines by the number of moves that meet a goal. All
/// machines have the same number of moves in the comparison: the first n moves of each measured machine, with
/// n the smallest number of moves of any machine.
Agreement agreement_with(const MetMoves& met_of_machines, const measures::MoveCounts& simulated,
                         std::uint64_t seed) {
  std::int64_t common = std::numeric_limits<std::int64_t>::max();
  for (const statistics::MachineMoves& machine : simulated.machines) common = std::min(common, machine.moves);
  for (const std::vector<bool>& met : met_of_machines) common = std::min(common, std::ssize(met));
  std::vector<std::int64_t> first_met;
  for (const std::vector<bool>& met : met_of_machines)
    first_met.push_back(std::count(met.begin(), met.begin() + common, true));
  return agreement_of(first_met, common, simulated.machines, seed);
}

/// Sets the predicted part of the claim, and whether the measured machines agree with it. If the study has
/// several worlds (draws of what all machines share), the prediction is that of the world most like the
/// measured machines, and the predicted interval spans the intervals of all worlds.
void compare_with_prediction(AcceptedGoal& claim, const measures::CellCounts& simulated, const MetMoves& met,
                             std::uint64_t seed) {
  if (simulated.shape().worlds > 0) claim.like_worlds = 0;
  const std::vector<measures::MoveCounts> worlds = simulated.worlds_in(0);
  statistics::ConfidenceInterval all{1.0, 0.0};
  for (std::size_t world = 0; world < worlds.size(); ++world) {
    const Agreement one = agreement_with(met, worlds[world], seed);
    all = {std::min(all.low, one.predicted.low), std::max(all.high, one.predicted.high)};
    if (claim.like_worlds && one.p > claim.significance) ++*claim.like_worlds;
    if (world > 0 && one.p <= claim.agreement.p) continue;
    claim.agreement = one;
    claim.predicted = goal::judge_goal(claim.goal, worlds[world], 1);
  }
  claim.agreement.predicted = all;
  claim.is_below_prediction = claim.agreement.p <= claim.significance && claim.agreement.is_lower;
}

/// Status of the goal for the measured machines alone, without a statement about other machines.
/// @param measured counts of the measured moves
/// @param parts number of goals that must all be met
goal::Status status_of_these(const study::Goal& goal, const measures::MoveCounts& measured,
                             std::size_t parts) {
  const auto bounds = [&](std::int64_t met, std::int64_t moves, std::size_t statements) {
    return bounded_rate(met, moves, statistics::confidence_of_each(goal.confidence, statements));
  };
  if (!goal.machines) {
    if (bounds(measured.met, measured.moves, 1).low >= goal.moves) return goal::Status::met;
    return bounds(measured.met, measured.moves, parts).high < goal.moves ? goal::Status::missed
                                                                         : goal::Status::undecided;
  }
  const std::size_t machines = measured.machines.size();
  std::int64_t meeting = 0;
  std::int64_t not_missing = 0;
  for (const statistics::MachineMoves& one : measured.machines) {
    meeting += bounds(one.met, one.moves, machines).low >= goal.moves;
    not_missing += bounds(one.met, one.moves, machines * parts).high >= goal.moves;
  }
  const double wanted = *goal.machines * static_cast<double>(machines);
  if (static_cast<double>(meeting) >= wanted) return goal::Status::met;
  return static_cast<double>(not_missing) < wanted ? goal::Status::missed : goal::Status::undecided;
}

/// Counts of the measured moves, with each machine as a cluster of dependent moves.
/// @param met_of_machines [machine][move] whether the move meets the goal
measures::CellCounts measured_counts(const MetMoves& met_of_machines) {
  measures::CellCounts measured({.machines = std::ssize(met_of_machines)});
  for (std::size_t i = 0; i < met_of_machines.size(); ++i) {
    const std::vector<bool>& met = met_of_machines[i];
    measured.add_machine(i, 0,
                         {.trials = std::ssize(met),
                          .moves = std::ssize(met),
                          .met = std::count(met.begin(), met.end(), true)});
  }
  return measured;
}

/// Sets the measured results and the status of each claim.
/// @param measured [goal] counts of the moves of the measured machines
void judge(Acceptance& acceptance, std::span<const study::Goal> goals,
           std::span<const measures::CellCounts> measured) {
  const goal::Verdict verdict = goal::judge_goals(goals, measured, 1);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    AcceptedGoal& claim = acceptance.claims[i];
    const measures::MoveCounts counts = measured[i].sum();
    claim.moves = counts.moves;
    claim.met = counts.met;
    claim.rate = bounded_rate(claim.met, claim.moves, goals[i].confidence);
    claim.measured = verdict.claims[i];
    claim.status = acceptance.judged == Judged::all_machines
                       ? claim.measured.status
                       : status_of_these(goals[i], counts, goals.size());
  }
  if (acceptance.judged == Judged::all_machines && verdict.status == goal::Status::undecided)
    acceptance.needed_machines = goal::needs_of(goals, measured, 1).machines;
}

using Sequence = std::span<const study::SequenceMove>;
using Values = std::vector<iso230::AxisRepeatability>;

/// The values of ISO 230-2 of one run of the test, computed from the encoder counts at the ends of its moves.
/// The true positions are not used. Null if the run has no values.
/// @param moves moves of the run, in the order of `sequence`
std::optional<iso230::AxisRepeatability> values_of_run(Sequence sequence,
                                                       std::span<const trial::MoveOutcome> moves) {
  trial::TrialParameters parameters;
  parameters.command.targets.resize(sequence.size());
  const auto values = iso230::trial_repeatability(sequence, parameters, moves);
  return values ? std::optional(values->from_encoder.axis) : std::nullopt;
}

Values simulated_values(const reading::AllTrialsFile& file, std::int64_t point) {
  Values values;
  const Sequence sequence = file.study().sequence;
  measures::visit_trials(file, file.rows_of(point),
                         [&](std::int64_t, std::span<const trial::MoveOutcome> moves) {
                           if (const auto of_trial = values_of_run(sequence, moves))
                             values.push_back(*of_trial);
                         });
  return values;
}

/// Appends the values of ISO 230-2 of each complete run of the test in a log. A run is complete if successive
/// rows hold all moves of `sequence` in order, each with a final error.
void add_measured(Sequence sequence, const monitor::MoveLog& log, Values& values) {
  const std::vector<double>& errors = log.find("final_error")->written;
  std::vector<trial::MoveOutcome> run;
  for (std::size_t row = 0; row < errors.size(); ++row) {
    const auto continues = [&] {
      return log.labels.of(row).number == std::ssize(run) && std::isfinite(errors[row]);
    };
    if (!continues()) run.clear();
    if (!continues()) continue;
    trial::MoveOutcome move;
    move.outcome = trial::Outcome::zero_count;
    move.final_error = std::llround(errors[row]);
    run.push_back(move);
    if (run.size() < sequence.size()) continue;
    if (const auto of_run = values_of_run(sequence, run)) values.push_back(*of_run);
    run.clear();
  }
}

/// Sample quantile at probability `p`, interpolated linearly between the values of a sorted sample.
double sample_quantile(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

constexpr int draws = 9999;

/// Number of moves that meet the goal among `wanted` moves of a machine, which are drawn at random without
/// replacement.
std::int64_t thinned(const statistics::MachineMoves& machine, std::int64_t wanted,
                     random::NumberSource& numbers) {
  std::int64_t remaining = machine.moves;
  std::int64_t met = machine.met;
  for (std::int64_t i = 0; i < wanted; ++i, --remaining)
    if (numbers.uniform() * static_cast<double>(remaining) < static_cast<double>(met)) --met;
  return machine.met - met;
}

std::size_t below(std::size_t count, random::NumberSource& numbers) {
  return std::min(count - 1, static_cast<std::size_t>(numbers.uniform() * static_cast<double>(count)));
}

/// Probability of one particular choice of N machines from N + R: 1 divided by the binomial coefficient of N
/// + R over N.
/// @param measured N, number of measured machines
/// @param simulated R, number of simulated machines
double chance_of_a_choice(std::size_t measured, std::size_t simulated) {
  double chance = 1.0;
  for (std::size_t i = 1; i <= measured; ++i)
    chance *= static_cast<double>(i) / static_cast<double>(simulated + i);
  return chance;
}

/// One random choice of the permutation test: the number of moves that meet the goal on N randomly chosen
/// machines, with N the number of measured machines. The measured machines have the indices 0 to N − 1, the
/// simulated machines the following ones.
/// @param met [measured machine] number of its moves that meet the goal
/// @param moves number of moves of each machine in the test
/// @param first index of the first machine that can be chosen: 0 for all machines, N for the simulated ones
/// alone
/// @param order working memory
std::int64_t drawn(std::span<const std::int64_t> met, std::int64_t moves,
                   std::span<const statistics::MachineMoves> simulated, std::size_t first,
                   std::vector<std::size_t>& order, random::NumberSource& numbers) {
  const std::size_t measured = met.size();
  order.resize(measured + simulated.size() - first);
  std::iota(order.begin(), order.end(), first);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < measured; ++i) {
    std::swap(order[i], order[i + below(order.size() - i, numbers)]);
    const std::size_t machine = order[i];
    sum += machine < measured ? met[machine] : thinned(simulated[machine - measured], moves, numbers);
  }
  return sum;
}

bool have_as_many_moves(std::span<const statistics::MachineMoves> machines) {
  return std::ranges::all_of(
      machines, [&](const statistics::MachineMoves& one) { return one.moves == machines[0].moves; });
}

double rank_test_of(std::int64_t met, std::int64_t moves,
                    std::span<const statistics::MachineMoves> simulated) {
  std::vector<std::int64_t> successes;
  for (const statistics::MachineMoves& machine : simulated) successes.push_back(machine.met);
  return statistics::machine_rank_test({met, moves}, successes, simulated[0].moves).p;
}

/// Names the first log that lacks a column for the values of ISO 230-2, and this column: "a.csv has no column
/// final_error". Empty if no log lacks a column.
std::string lacking_for_standard(std::span<const monitor::MoveLog> logs) {
  for (const monitor::MoveLog& log : logs) {
    const bool has_error = log.find("final_error") != nullptr;
    if (has_error && log.labels.numbered) continue;
    return fmt::format("{} has no column {}", log.name,
                       has_error ? missing_text(log, "move") : missing_text(log, "final_error"));
  }
  return "";
}

/// The values of ISO 230-2 for the axis, from the simulated and the measured runs. Empty if the study has no
/// sequence of moves, or a log lacks one of the columns `final_error` and `move`. A measured run is a series
/// of successive rows whose moves have the numbers 0 to the last one of the sequence, in this order; other
/// rows are left out.
std::vector<StandardValue> standard_values(const reading::AllTrialsFile& file, std::int64_t point,
                                           std::span<const monitor::MoveLog> logs) {
  const Sequence sequence = file.study().sequence;
  if (sequence.empty() || !lacking_for_standard(logs).empty()) return {};
  Values measured;
  for (const monitor::MoveLog& log : logs) add_measured(sequence, log, measured);
  if (measured.empty()) return {};
  const Values simulated = simulated_values(file, point);
  std::vector<StandardValue> values;
  for (const auto& field : iso230::axis_fields()) {
    std::vector<double> sorted;
    for (const iso230::AxisRepeatability& one : simulated)
      if (std::isfinite(one.*field.value)) sorted.push_back(one.*field.value);
    if (sorted.empty()) continue;
    std::ranges::sort(sorted);
    StandardValue value{.name = field.name, .symbol = field.symbol};
    value.median = sample_quantile(sorted, 0.5);
    value.low = sample_quantile(sorted, 0.025);
    value.high = sample_quantile(sorted, 0.975);
    for (const iso230::AxisRepeatability& one : measured) {
      value.measured.push_back(one.*field.value);
      value.within += one.*field.value >= value.low && one.*field.value <= value.high ? 1 : 0;
    }
    values.push_back(std::move(value));
  }
  return values;
}

}  // namespace

Status status_of(const AcceptedGoal& claim) {
  if (claim.status == goal::Status::missed || claim.is_below_prediction) return Status::rejected;
  return claim.status == goal::Status::met ? Status::accepted : Status::undecided;
}

Status status_of(const Acceptance& acceptance) {
  const auto any = [&](Status status) {
    return std::ranges::any_of(acceptance.claims,
                               [&](const AcceptedGoal& claim) { return status_of(claim) == status; });
  };
  return any(Status::rejected)    ? Status::rejected
         : any(Status::undecided) ? Status::undecided
                                  : Status::accepted;
}

ExitCode exit_code_of(Status status) {
  if (status == Status::accepted) return ExitCode::success;
  return status == Status::rejected ? ExitCode::regression : ExitCode::inconclusive;
}

Acceptance accept(const reading::AllTrialsFile& file, std::int64_t point,
                  std::span<const monitor::MoveLog> logs, Judged judged) {
  const study::Study& study = file.study();
  const std::string path = file.path().string();
  if (study.machines == 0)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: no trials share a machine, so machines cannot be distinguished from moves; "
                    "expected machines: 50, or more",
                    path));
  Acceptance acceptance{.study = path, .point = file.point_labels()[static_cast<std::size_t>(point)]};
  acceptance.judged = judged;
  for (const monitor::MoveLog& log : logs) {
    if (log.moves == 0)
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}: has no moves; expected a row for each move of the machine", log.name));
    require_columns(study.goals, log);
    acceptance.machines.push_back({.name = log.name});
  }
  const std::vector<measures::CellCounts> simulated = simulated_counts(file, point);
  std::vector<measures::CellCounts> measured;
  for (std::size_t i = 0; i < study.goals.size(); ++i) {
    MetMoves met;
    for (std::size_t machine = 0; machine < logs.size(); ++machine) {
      met.push_back(met_moves(study.goals[i], logs[machine], file));
      acceptance.machines[machine].moves.push_back(std::ssize(met.back()));
      acceptance.machines[machine].met.push_back(std::ranges::count(met.back(), true));
    }
    measured.push_back(measured_counts(met));
    AcceptedGoal& claim = acceptance.claims.emplace_back(AcceptedGoal{.goal = study.goals[i]});
    claim.significance /= static_cast<double>(study.goals.size());
    compare_with_prediction(claim, simulated[i], met, study.seed);
    acceptance.simulated = study.machines;
  }
  judge(acceptance, study.goals, measured);
  acceptance.worlds = study.worlds;
  acceptance.standard_values = standard_values(file, point, logs);
  if (!study.sequence.empty()) acceptance.standard_lacks = lacking_for_standard(logs);
  for (const study::Premise& premise : study.premises)
    if (premise.state == study::PremiseState::assumed) acceptance.assumed.emplace_back(premise.assumption);
  return acceptance;
}

Agreement agreement_of(std::span<const std::int64_t> met, std::int64_t moves,
                       std::span<const statistics::MachineMoves> simulated, std::uint64_t seed) {
  random::NumberSource numbers(designs::random_key(seed, "acceptance"));
  Agreement agreement{.moves = moves, .met = std::accumulate(met.begin(), met.end(), std::int64_t{0})};
  std::vector<std::size_t> order;
  int at_most = 0;
  int at_least = 0;
  std::vector<std::int64_t> predicted;
  for (int i = 0; i < draws; ++i) {
    const std::int64_t any = drawn(met, moves, simulated, 0, order, numbers);
    at_most += any <= agreement.met ? 1 : 0;
    at_least += any >= agreement.met ? 1 : 0;
    // The prediction takes as many simulated machines as are measured, or all if there are fewer.
    predicted.push_back(drawn(met.first(std::min(met.size(), simulated.size())), moves, simulated,
                              std::min(met.size(), simulated.size()), order, numbers));
  }
  const double low = (1.0 + at_most) / (draws + 1.0);
  const double high = (1.0 + at_least) / (draws + 1.0);
  agreement.p = std::min(1.0, 2.0 * std::min(low, high));
  agreement.is_lower = low < high;
  agreement.lowest_p =
      std::min(1.0, 2.0 * std::max(1.0 / (draws + 1.0), chance_of_a_choice(met.size(), simulated.size())));
  if (met.size() == 1 && have_as_many_moves(simulated)) agreement.p = rank_test_of(met[0], moves, simulated);
  std::ranges::sort(predicted);
  const auto of_moves =
      static_cast<double>(moves) * static_cast<double>(std::min(met.size(), simulated.size()));
  agreement.predicted = {static_cast<double>(predicted[draws / 40]) / of_moves,
                         static_cast<double>(predicted[draws - 1 - draws / 40]) / of_moves};
  return agreement;
}

}  // namespace zerocount::acceptance
