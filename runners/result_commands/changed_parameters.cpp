#include "runners/result_commands/changed_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/fields.hpp"
#include "runners/result_commands/change_causes.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::result_commands {
namespace {

using monitor::ChangeKind;
using Machines = std::vector<monitor::MoveValues>;

constexpr std::int64_t max_simulated_machines = 64;
/// Number of trials per change of a parameter; enough to see whether the change has any effect.
constexpr std::int64_t pilot_trials = 16;
/// Number of trials per change of a parameter; enough to see which parameters do not fit the log.
constexpr std::int64_t screened_trials = 64;

/// A stage of the explanation that simulates more changes near the likeliest change of each parameter, with
/// more trials.
struct Refinement {
  std::int64_t trials;  ///< Number of trials that are simulated with each change.
  /// Maximum number of likeliest parameters to simulate again among those that fit the log. Other fitting
  /// ones keep their results.
  std::size_t max_parameters;
  /// Number of likeliest parameters that are simulated again even if they do not fit the log.
  std::size_t min_parameters;
  std::size_t changes;  ///< Number of changes of each parameter that are simulated.
};
constexpr std::array refinements{
    Refinement{.trials = 128, .max_parameters = 8, .min_parameters = 3, .changes = 5},
    Refinement{.trials = 512, .max_parameters = 4, .min_parameters = 2, .changes = 4}};

struct WatchedField {
  const layout::RecordField<trial::MoveOutcome>* field;
  monitor::MonitoredMeasure measure;
  double evidence;  ///< Evidence of the monitor that the measure has changed; larger is stronger.
};

/// Data behind an alarm of the monitor: the study, its simulated moves, the log and the measures that are
/// watched.
struct Alarm {
  const study::Study& study;
  const monitor::ModelMoves& moves;
  const monitor::Likes& likes;
  const monitor::MoveLog& log;
  const std::vector<WatchedField>& watched;
  const trials::Effort& effort;
};

/// Whether the study draws some value that differs from one machine to another.
bool machines_differ(const study::Study& study, std::int64_t point) {
  const study::StudyPlan& plan = *study.plan;
  const std::size_t place = study::plan_point(plan, point);
  for (std::size_t slot = 0; slot < plan.table.rows.size(); ++slot) {
    if (!plan.table.rows[slot].of_machine) continue;
    const study::Value* const value = study::value_at_point(plan, slot, place);
    if (value == nullptr) continue;
    const bool is_drawn = value->kind == study::Value::Kind::distribution && !is_drawn_per_contact(*value);
    if (is_drawn || (value->kind == study::Value::Kind::profile && plan.profiles[value->index]->count() > 1))
      return true;
  }
  return false;
}

/// Numbers of machines and trials to simulate. The machines are the machines of the study or, without
/// `machines`, its trials. If no drawn quantity differs between them, all trials belong to one machine.
struct SimulatedMachines {
  std::int64_t machines;
  std::int64_t trials_of_machine;
  /// Whether all trials belong to one machine, because no drawn quantity differs between trials.
  bool are_one;

  std::int64_t trials() const { return machines * trials_of_machine; }
};

/// Numbers of machines and trials to simulate, at most `max_trials` trials together. If the study's machines
/// differ, each has two or more trials, so that differences between machines can be separated from
/// differences within a machine.
SimulatedMachines machines_of(const Alarm& alarm, std::int64_t max_trials) {
  const study::Study& study = alarm.study;
  if (alarm.moves.machine) return {1, std::min(study.trials / study.machines, max_trials), false};
  if (!machines_differ(study, alarm.moves.point)) return {1, std::min(study.trials, max_trials), true};
  if (study.machines == 0) return {std::min(study.trials, max_trials), 1, false};
  const std::int64_t machines = std::min({study.machines, max_simulated_machines, max_trials / 2});
  return {machines, std::min(study.trials / study.machines, max_trials / machines), false};
}

/// Simulates the machines with a changed parameter, and holds their moves without a change.
class Simulations {
 public:
  Simulations(const Alarm& alarm, const SimulatedMachines& machines) : of_(alarm), machines_(machines) {
    same_ = simulated(alarm.study, [](trial::TrialParameters&) {});
  }

  const Machines& same() const { return same_; }

  /// [machine] Values of the moves with this change of the parameter; nothing if a value would be impossible.
  /// @param change factor or amount
  std::optional<Machines> changed(const Cause& cause, double change) const {
    if (change == monitor::unchanged_by(cause.kind)) return same_;
    if (cause.add)
      return simulated(of_.study, [&](trial::TrialParameters& drawn) { cause.add(drawn, change); });
    const std::optional<study::Study> study = study_with_factor(of_.study, of_.moves.point, cause, change);
    if (!study) return std::nullopt;
    return simulated(*study, [](trial::TrialParameters&) {});
  }

  /// Explains the alarm from the moves of the log: which of the candidates (changed parameters) make the
  /// simulated moves like those.
  monitor::ChangeExplanation explained(std::vector<monitor::ChangeCandidate> candidates) const;

 private:
  /// Number, within the design point, of the trial that is number `number` among the simulated ones.
  std::int64_t index(std::int64_t number) const {
    if (machines_.are_one) return number;
    const std::int64_t machine = of_.moves.machine.value_or(number / machines_.trials_of_machine);
    return machine + of_.study.machines * (number % machines_.trials_of_machine);
  }

  /// [machine] Values of the watched measures of the simulated moves.
  /// @param change changes the parameters of each drawn trial
  Machines simulated(const study::Study& study,
                     const std::function<void(trial::TrialParameters&)>& change) const {
    const auto draw = [&](std::int64_t number) {
      trial::TrialParameters drawn = study::study_trial(study, of_.moves.point, index(number)).parameters;
      change(drawn);
      return drawn;
    };
    const std::int64_t count = machines_.trials();
    const auto values = trials::results_of(
        count, trials::block_for_lanes(count), draw, of_.effort, [&](const trial::TrialOutcome& outcome) {
          monitor::MoveValues moves;
          for (const trial::MoveOutcome& move : outcome.moves)
            for (const WatchedField& one : of_.watched)
              moves.push_back(monitor::ranked_value(one.measure, layout::value_of(*one.field, move)));
          return moves;
        });
    Machines machines(static_cast<std::size_t>(machines_.machines));
    for (std::size_t i = 0; i < values.size(); ++i) {
      monitor::MoveValues& machine = machines[i / static_cast<std::size_t>(machines_.trials_of_machine)];
      machine.insert(machine.end(), values[i].begin(), values[i].end());
    }
    return machines;
  }

  const Alarm& of_;
  SimulatedMachines machines_;
  Machines same_;  ///< [machine] Values of the moves without a change.
};

/// Replaces the values of each machine's moves by their ranks among the unchanged moves of the same kind (the
/// same target, for example), so that moves of different kinds can be compared. If there is only one kind,
/// the values stay.
class RanksAmongLikes {
 public:
  /// @param likes [machine][move] kind of the move, as an index
  /// @param unchanged [machine] values of the moves without a change
  RanksAmongLikes(const Alarm& alarm, const std::vector<std::vector<std::size_t>>& likes,
                  const Machines& unchanged)
      : likes_(alarm.likes), watched_(alarm.watched), sorted_(likes_.count() * watched_.size()) {
    for (std::size_t machine = 0; machine < unchanged.size(); ++machine)
      for (std::size_t i = 0; i < unchanged[machine].size(); ++i) {
        const std::size_t like = likes[machine][i / watched_.size()];
        sorted_[place_of(like, i)].push_back(oriented(like, i, unchanged[machine][i]));
      }
    for (std::vector<double>& values : sorted_) std::ranges::sort(values);
  }

  bool knows(std::size_t like) const { return !sorted_[place_of(like, 0)].empty(); }

  void replace(monitor::MoveValues& moves, const std::vector<std::size_t>& likes) const {
    if (likes_.count() < 2) return;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const std::size_t like = likes[i / watched_.size()];
      const std::vector<double>& values = sorted_[place_of(like, i)];
      moves[i] = (monitor::mid_rank(values, oriented(like, i, moves[i])) + 0.5) /
                 static_cast<double>(values.size() + 1);
    }
  }

 private:
  std::size_t place_of(std::size_t like, std::size_t i) const {
    return like * watched_.size() + i % watched_.size();
  }
  double oriented(std::size_t like, std::size_t i, double value) const {
    return likes_.oriented(watched_[i % watched_.size()].measure, like, value);
  }

  const monitor::Likes& likes_;
  const std::vector<WatchedField>& watched_;
  /// [kind of move and measure] Values of the unchanged moves, in ascending order.
  std::vector<std::vector<double>> sorted_;
};

monitor::ChangeExplanation Simulations::explained(std::vector<monitor::ChangeCandidate> candidates) const {
  std::vector<std::vector<std::size_t>> likes(
      static_cast<std::size_t>(machines_.machines));  // [machine][move]
  for (std::int64_t number = 0; number < machines_.trials(); ++number)
    for (const monitor::MoveLabel& label :
         monitor::labels_of(study::commanded_trial(of_.study, of_.moves.point, index(number)).parameters))
      likes[static_cast<std::size_t>(number / machines_.trials_of_machine)].push_back(
          of_.likes.of_own(label).value_or(0));
  const RanksAmongLikes ranks(of_, likes, same_);
  for (monitor::ChangeCandidate& candidate : candidates)
    for (monitor::SimulatedChange& change : candidate.changes)
      for (std::size_t i = 0; i < change.machines.size(); ++i) ranks.replace(change.machines[i], likes[i]);

  std::vector<std::int64_t> numbers;  // in the log, from 1, of the moves that have a like
  std::vector<std::size_t> likes_of_log;
  monitor::MoveValues observed;
  for (std::size_t move = 0; move < static_cast<std::size_t>(of_.log.moves); ++move) {
    const std::optional<std::size_t> like = of_.likes.of(of_.log.labels.of(move));
    if (!like || !ranks.knows(*like)) continue;
    numbers.push_back(static_cast<std::int64_t>(move) + 1);
    likes_of_log.push_back(*like);
    for (const WatchedField& one : of_.watched)
      observed.push_back(of_.log.find(one.measure.name)->values[move]);
  }
  ranks.replace(observed, likes_of_log);
  monitor::ChangeExplanation explanation = monitor::explain_change(candidates, observed, of_.watched.size());
  if (explanation.since > 1) explanation.since = numbers[static_cast<std::size_t>(explanation.since - 1)];
  return explanation;
}

/// Parameters whose change has an effect on the watched measures, with their simulated moves.
struct Screening {
  std::vector<monitor::ChangeCandidate> candidates{};
  /// Names of the parameters that were not tried, because the effort was not enough.
  std::vector<std::string> untried{};
};

/// Whether the parameter has an effect on the watched measures: its smallest or its largest change alters
/// simulated moves.
bool acts(const Simulations& pilot, const Cause& cause) {
  return std::ranges::any_of(std::array{cause.changes.front(), cause.changes.back()}, [&](double change) {
    const std::optional<Machines> moves = pilot.changed(cause, change);
    return moves && *moves != pilot.same();
  });
}

monitor::ChangeCandidate candidate_of(const Simulations& simulations, const Cause& cause) {
  monitor::ChangeCandidate candidate{cause.name, {}, cause.kind, cause.unit};
  for (const double change : cause.changes)
    if (auto moves = simulations.changed(cause, change))
      candidate.changes.push_back({change, std::move(*moves)});
  return candidate;
}

Screening screened(const Simulations& pilot, const Simulations& simulations, const std::vector<Cause>& causes,
                   const trials::Effort& effort) {
  Screening screening;
  for (const Cause& cause : causes) {
    const bool ended = screening.untried.empty() && trials::within(effort, [&] {
                         if (!acts(pilot, cause)) return;
                         monitor::ChangeCandidate candidate = candidate_of(simulations, cause);
                         if (candidate.changes.size() > 1)
                           screening.candidates.push_back(std::move(candidate));
                       });
    if (!ended) screening.untried.push_back(cause.name);
  }
  return screening;
}

/// Simulates `count` further changes of the parameter around the interval `near`, with more trials, and
/// replaces the unchanged machines of the candidate by those with as many trials.
void refine(monitor::ChangeCandidate& candidate, const monitor::ParameterChange& near, const Cause& cause,
            std::size_t count, const Simulations& simulations) {
  const bool is_factor = candidate.kind == ChangeKind::factor;
  const auto place = [&](double change) { return is_factor ? std::log(change) : change; };
  std::vector<monitor::SimulatedChange>& changes = candidate.changes;
  const double first = place(changes.front().change);
  const double last = place(changes.back().change);
  const double width = std::max(place(near.high) - place(near.low), 0.04 * (last - first));
  const double middle = 0.5 * (place(near.low) + place(near.high));
  const double low = std::max(first, middle - 0.7 * width);
  const double high = std::min(last, middle + 0.7 * width);
  const auto set = [&](double change, Machines machines) {
    const auto at = std::ranges::lower_bound(changes, change, {}, &monitor::SimulatedChange::change);
    if (at != changes.end() && at->change == change)
      at->machines = std::move(machines);
    else
      changes.insert(at, {change, std::move(machines)});
  };
  set(monitor::unchanged_by(candidate.kind), simulations.same());
  for (std::size_t i = 0; i < count; ++i) {
    const double at = std::lerp(low, high, static_cast<double>(i) / static_cast<double>(count - 1));
    const double change = is_factor ? std::exp(at) : at;
    if (auto moves = simulations.changed(cause, change)) set(change, std::move(*moves));
  }
}

/// Maximum number of trials that the explanation of an alarm takes.
std::int64_t max_trials_of(const Alarm& alarm, const std::vector<Cause>& causes) {
  const std::int64_t of_pilot = machines_of(alarm, pilot_trials).trials();
  const std::int64_t of_screening = machines_of(alarm, screened_trials).trials();
  std::int64_t trials = of_pilot + of_screening;
  for (const Cause& cause : causes) trials += 2 * of_pilot + (std::ssize(cause.changes) - 1) * of_screening;
  for (const Refinement& one : refinements)
    trials += machines_of(alarm, one.trials).trials() *
              static_cast<std::int64_t>(1 + one.changes * std::min(one.max_parameters, causes.size()));
  return trials;
}

/// Explanation of the alarm from more trials with changes near the likeliest ones. The candidates are then
/// the parameters simulated again, and all others that fit the log.
/// @param before explanation by the previous stage
monitor::ChangeExplanation refined(const Alarm& alarm, const Refinement& refinement,
                                   const std::vector<Cause>& causes, const monitor::ChangeExplanation& before,
                                   std::vector<monitor::ChangeCandidate>& candidates) {
  const Simulations simulations(alarm, machines_of(alarm, refinement.trials));
  std::vector<monitor::ChangeCandidate> kept;
  for (std::size_t i = 0; i < before.ranked.size(); ++i) {
    const monitor::ParameterChange& one = before.ranked[i];
    if (i >= refinement.min_parameters && !one.fits()) continue;
    kept.push_back(*std::ranges::find(candidates, one.parameter, &monitor::ChangeCandidate::parameter));
    const bool is_near = kept.size() <= refinement.max_parameters;
    refine(kept.back(), one, *std::ranges::find(causes, one.parameter, &Cause::name),
           is_near ? refinement.changes : 0, simulations);
  }
  monitor::ChangeExplanation explanation = simulations.explained(kept);
  candidates = std::move(kept);
  explanation.tried = before.tried;
  return explanation;
}

}  // namespace

monitor::ChangeExplanation explain_alarm(const reading::AllTrialsFile& file, const monitor::ModelMoves& moves,
                                         const monitor::MachineMonitor& machine, const monitor::MoveLog& log,
                                         const std::vector<std::string>& unchanged,
                                         const trials::Effort& effort) {
  std::vector<WatchedField> watched;
  for (const monitor::MeasureState& one : machine.measures())
    for (const auto& field : file.measures())
      if (field.column.name == one.measure.name) watched.push_back({&field, one.measure, one.evidence});
  std::ranges::stable_sort(watched, std::greater{}, &WatchedField::evidence);
  const Alarm alarm{file.study(), moves, machine.likes(), log, watched, effort};
  std::vector<Cause> causes = causes_of(file.study(), moves.point);
  std::erase_if(causes, [&](const Cause& cause) {
    return std::ranges::any_of(unchanged, [&](const auto& name) { return is_named(cause.name, name); });
  });
  monitor::ChangeExplanation explanation{.reason = "no parameter was tried"};
  Screening screening;
  if (!trials::within(effort, [&] {
        const Simulations pilot(alarm, machines_of(alarm, pilot_trials));
        const Simulations simulations(alarm, machines_of(alarm, screened_trials));
        screening = screened(pilot, simulations, causes, effort);
        if (!screening.candidates.empty() || screening.untried.empty())
          explanation = simulations.explained(screening.candidates);
      }))
    for (const Cause& cause : causes) screening.untried.push_back(cause.name);
  for (const Refinement& refinement : refinements)
    if (explanation.told != monitor::ExplanationKind::unknown)
      trials::within(effort, [&] {
        explanation = refined(alarm, refinement, causes, explanation, screening.candidates);
      });
  explanation.untried = std::move(screening.untried);
  explanation.max_trials = max_trials_of(alarm, causes);
  if (explanation.told == monitor::ExplanationKind::one && !explanation.untried.empty())
    explanation.told = monitor::ExplanationKind::several;
  return explanation;
}

}  // namespace zerocount::result_commands
