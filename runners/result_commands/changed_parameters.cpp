#include "runners/result_commands/changed_parameters.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/point_edit.hpp"
#include "results/layout/fields.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::result_commands {
namespace {

constexpr std::array<std::string_view, 15> scaled_names{"friction.k1",           "friction.k2",
                                                        "friction.beta",         "friction.alpha",
                                                        "friction.lambda",       "friction.breakaway",
                                                        "friction.sigma0",       "friction.sigma1",
                                                        "plant.inertia",         "plant.presliding_damping",
                                                        "plant.sliding_damping", "controller.kp",
                                                        "controller.ki",         "controller.kd",
                                                        "amplifier.bandwidth"};
constexpr std::array<double, 13> tried_factors{0.5,  0.6,  0.7,  0.8,  0.87, 0.94, 1.0,
                                               1.06, 1.15, 1.25, 1.43, 1.67, 2.0};

/// A parameter that is 0 in most studies, to which something is added.
struct AddedCause {
  std::string_view name;
  std::string_view unit;
  std::vector<double> amounts;  ///< rising, 0 among them
  void (*add)(trial::TrialParameters& parameters, double amount);
};

/// Widens a zone of errors, which negative bounds switch off.
void widen(double& bound, double amount) {
  bound = std::max(bound, 0.0) + amount;
}

std::vector<AddedCause> added_causes() {
  using Trial = trial::TrialParameters;
  return {{"encoder.fine_errors.noise",
           "count",
           {0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8},
           [](Trial& p, double amount) { p.encoder.fine_errors.noise += amount; }},
          // Factors of the torque less one: the gain error stays above -1.
          {"dac.gain_error",
           "",
           {-0.5, -0.4, -0.3, -0.2, -0.13, -0.06, 0.0, 0.06, 0.15, 0.25, 0.43, 0.67, 1.0},
           [](Trial& p, double amount) { p.dac.gain_error += amount * (1.0 + p.dac.gain_error); }},
          {"controller.delay",
           "sample",
           {0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0},
           [](Trial& p, double amount) { p.controller.delay += amount; }},
          // Errors are whole counts.
          {"controller.deadband.enter",
           "count",
           {0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0},
           [](Trial& p, double amount) { widen(p.controller.blocks.deadband.enter, amount); }},
          {"controller.error_deadband.band",
           "count",
           {0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0},
           [](Trial& p, double amount) { widen(p.controller.blocks.error_deadband.band, amount); }}};
}

/// Whether the dotted path is what is named: it begins with the first part, and has the others in their
/// order.
bool is_named(std::string_view path, std::string_view name) {
  bool first = true;
  while (!name.empty()) {
    const std::string_view part = name.substr(0, name.find('.'));
    bool found = false;
    while (!path.empty() && !found) {
      const std::string_view step = path.substr(0, path.find('.'));
      path.remove_prefix(std::min(path.size(), step.size() + 1));
      found = step == part;
      if (first && !found) return false;
      first = false;
    }
    if (!found) return false;
    name.remove_prefix(std::min(name.size(), part.size() + 1));
  }
  return !first;
}

bool is_unchanged(std::string_view path, const std::vector<std::string>& unchanged) {
  return std::ranges::any_of(unchanged, [&](const std::string& name) { return is_named(path, name); });
}

constexpr std::int64_t max_simulated_machines = 64;
constexpr std::int64_t max_simulated_trials = 1024;
/// The changes that are far less likely than others are simulated with fewer trials.
constexpr std::int64_t max_screened_trials = 256;
constexpr double hopeless = 1e-4;  // probability
constexpr std::int64_t trials_of_block = 64;

/// The trials of the simulated machines.
struct MachineTrials {
  std::vector<std::int64_t> machines;  ///< rigs; without rigs trials
  std::int64_t of_machine{1};          ///< trials of each

  std::int64_t count() const { return std::ssize(machines) * of_machine; }
  std::int64_t index(const study::Study& study, std::int64_t number) const {
    const std::int64_t machine = machines[static_cast<std::size_t>(number / of_machine)];
    return study.rigs > 0 ? machine + study.rigs * (number % of_machine) : machine;
  }
};

MachineTrials machine_trials(const study::Study& study, const monitor::ModelMoves& moves,
                             std::int64_t max_trials) {
  MachineTrials chosen;
  const std::int64_t all = study.rigs > 0 ? study.rigs : study.trials;
  if (moves.rig) {
    chosen.machines = {*moves.rig};
  } else {
    for (std::int64_t i = 0; i < std::min(all, max_simulated_machines); ++i) chosen.machines.push_back(i);
  }
  if (study.rigs > 0) {
    const std::int64_t most = std::max<std::int64_t>(1, max_trials / std::ssize(chosen.machines));
    chosen.of_machine = std::min(study.trials / study.rigs, most);
  }
  return chosen;
}

using Field = layout::RecordField<trial::MoveOutcome>;

struct WatchedField {
  const Field* field;
  monitor::MonitoredMeasure measure;
  double evidence;  ///< of its change
};

/// @param change of the drawn parameters
std::vector<monitor::MachineMoves> simulated(
    const study::Study& study, std::int64_t point, const MachineTrials& chosen,
    const std::vector<WatchedField>& watched, const trials::Effort& effort,
    const std::function<void(trial::TrialParameters&)>& change = [](trial::TrialParameters&) {}) {
  const auto draw = [&](std::int64_t number) {
    trial::TrialParameters drawn = study::study_trial(study, point, chosen.index(study, number)).parameters;
    change(drawn);
    return drawn;
  };
  const auto values = trials::results_of(
      chosen.count(), trials_of_block, draw, effort, [&](const trial::TrialOutcome& outcome) {
        monitor::MachineMoves moves;
        for (const trial::MoveOutcome& move : outcome.moves)
          for (const WatchedField& one : watched)
            moves.push_back(monitor::ranked_value(one.measure, layout::value_of(*one.field, move)));
        return moves;
      });
  std::vector<monitor::MachineMoves> machines(chosen.machines.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    monitor::MachineMoves& machine = machines[i / static_cast<std::size_t>(chosen.of_machine)];
    machine.insert(machine.end(), values[i].begin(), values[i].end());
  }
  return machines;
}

/// Whether the study has the parameter as a number or a distribution that can be scaled.
bool can_be_scaled(const study::Study& study, std::int64_t point, std::string_view name) {
  const study::PointEdit edit(study, point);
  const study::ValueLimits limits = edit.limits(name);
  return limits.low != 0.0 || limits.high != 0.0;
}

/// The study, point and trials that are simulated with each change.
struct Simulations {
  const study::Study& study;
  std::int64_t point;
  const MachineTrials& chosen;
  const std::vector<WatchedField>& watched;
  const trials::Effort& effort;
  std::vector<monitor::MachineMoves> same;  ///< without a change
};

/// The moves with the parameter multiplied; nothing where it would leave its range.
std::optional<std::vector<monitor::MachineMoves>> scaled_moves(const Simulations& of, std::string_view name,
                                                               double factor) {
  if (factor == 1.0) return of.same;
  study::PointEdit edit(of.study, of.point);
  edit.scale(name, factor);
  if (!edit.out_of_range().empty()) return std::nullopt;
  return simulated(edit.study(), of.point, of.chosen, of.watched, of.effort);
}

std::vector<monitor::MachineMoves> added_moves(const Simulations& of, const AddedCause& cause,
                                               double amount) {
  if (amount == 0.0) return of.same;
  return simulated(of.study, of.point, of.chosen, of.watched, of.effort,
                   [&](trial::TrialParameters& p) { cause.add(p, amount); });
}

/// With one change alone if the parameter does not act on what is watched.
monitor::ChangeCandidate scaled_candidate(const Simulations& of, std::string_view name) {
  monitor::ChangeCandidate candidate{std::string(name), {}};
  for (const double factor : tried_factors) {
    auto moves = scaled_moves(of, name, factor);
    if (!moves) continue;
    candidate.changes.push_back({factor, std::move(*moves)});
    if (candidate.changes.size() == 1 && candidate.changes[0].machines == of.same) break;
  }
  return candidate;
}

monitor::ChangeCandidate added_candidate(const Simulations& of, const AddedCause& cause) {
  monitor::ChangeCandidate candidate{
      std::string(cause.name), {}, monitor::ChangeKind::amount, std::string(cause.unit)};
  for (const double amount : cause.amounts)
    candidate.changes.push_back({amount, added_moves(of, cause, amount)});
  return candidate;
}

/// Simulates the changes of the interval, and the next one on each side, with these trials.
void refine(monitor::ChangeCandidate& candidate, const monitor::ParameterChange& interval,
            const Simulations& of) {
  std::vector<monitor::SimulatedChange>& changes = candidate.changes;
  const auto at = [&](double change) {
    return std::ranges::lower_bound(changes, change, {}, &monitor::SimulatedChange::change) - changes.begin();
  };
  const std::ptrdiff_t last = std::min(std::ssize(changes) - 1, at(interval.high) + 1);
  for (std::ptrdiff_t i = 0; i < std::ssize(changes); ++i) {
    monitor::SimulatedChange& change = changes[static_cast<std::size_t>(i)];
    const bool is_unchanged = change.change == monitor::unchanged_by(candidate.kind);
    if (!is_unchanged && (i < at(interval.low) - 1 || i > last)) continue;
    if (candidate.kind == monitor::ChangeKind::factor) {
      if (auto moves = scaled_moves(of, candidate.parameter, change.change)) change.machines = *moves;
      continue;
    }
    const std::vector<AddedCause> causes = added_causes();
    change.machines =
        added_moves(of, *std::ranges::find(causes, candidate.parameter, &AddedCause::name), change.change);
  }
}

/// Replaces the values of each machine's moves by their ranks among the unchanged moves like them, so that
/// moves of different targets are alike. Without likes the values stay.
class RanksAmongLikes {
 public:
  /// @param likes [machine][move] @param unchanged [machine]
  RanksAmongLikes(const monitor::Likes& likes, const std::vector<WatchedField>& watched,
                  const std::vector<std::vector<std::size_t>>& likes_of_machines,
                  const std::vector<monitor::MachineMoves>& unchanged)
      : likes_(likes), watched_(watched), sorted_(likes.count() * watched.size()) {
    for (std::size_t machine = 0; machine < unchanged.size(); ++machine)
      for (std::size_t i = 0; i < unchanged[machine].size(); ++i)
        sorted_[place_of(likes_of_machines[machine][i / watched.size()], i)].push_back(
            oriented(likes_of_machines[machine][i / watched.size()], i, unchanged[machine][i]));
    for (std::vector<double>& values : sorted_) std::ranges::sort(values);
  }

  bool knows(std::size_t like) const { return !sorted_[place_of(like, 0)].empty(); }

  void replace(monitor::MachineMoves& moves, const std::vector<std::size_t>& likes) const {
    if (likes_.count() < 2) return;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const std::size_t like = likes[i / watched_.size()];
      const std::vector<double>& values = sorted_[place_of(like, i)];
      const auto [first, last] = std::equal_range(values.begin(), values.end(), oriented(like, i, moves[i]));
      moves[i] = (0.5 * static_cast<double>((first - values.begin()) + (last - values.begin())) + 0.5) /
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
  std::vector<std::vector<double>> sorted_;  ///< [like][measure]
};

/// [machine][move] the likes of the simulated moves.
std::vector<std::vector<std::size_t>> likes_of_machines(const study::Study& study, std::int64_t point,
                                                        const MachineTrials& chosen,
                                                        const monitor::Likes& likes) {
  std::vector<std::vector<std::size_t>> machines(chosen.machines.size());
  for (std::int64_t number = 0; number < chosen.count(); ++number) {
    const auto trial = study::commanded_trial(study, point, chosen.index(study, number)).parameters;
    for (const monitor::MoveLabel& label : monitor::labels_of(trial))
      machines[static_cast<std::size_t>(number / chosen.of_machine)].push_back(
          likes.of_own(label).value_or(0));
  }
  return machines;
}

/// The moves of the log that have a like, and what is watched of them, move after move.
struct ObservedMoves {
  std::vector<std::int64_t> numbers;  ///< in the log, from 1
  std::vector<std::size_t> likes;
  monitor::MachineMoves values;
};

ObservedMoves observed_moves(const monitor::MoveLog& log, const std::vector<WatchedField>& watched,
                             const monitor::Likes& likes, const RanksAmongLikes& ranks) {
  std::vector<const std::vector<double>*> columns;
  for (const WatchedField& one : watched) columns.push_back(&log.find(one.measure.name)->values);
  ObservedMoves observed;
  for (std::size_t move = 0; move < static_cast<std::size_t>(log.moves()); ++move) {
    const std::optional<std::size_t> like = likes.of(log.labels().of(move));
    if (!like || !ranks.knows(*like)) continue;
    observed.numbers.push_back(static_cast<std::int64_t>(move) + 1);
    observed.likes.push_back(*like);
    for (const std::vector<double>* const column : columns) observed.values.push_back((*column)[move]);
  }
  ranks.replace(observed.values, observed.likes);
  return observed;
}

/// Whether a parameter is tried.
using IsTried = std::function<bool(std::string_view)>;

/// The candidates that act on what is watched, of those that are tried.
std::vector<monitor::ChangeCandidate> candidates_of(const Simulations& simulations, const IsTried& is_tried) {
  std::vector<monitor::ChangeCandidate> candidates;
  for (const std::string_view name : scaled_names) {
    if (!is_tried(name) || !can_be_scaled(simulations.study, simulations.point, name)) continue;
    monitor::ChangeCandidate one = scaled_candidate(simulations, name);
    if (one.changes.size() > 1) candidates.push_back(std::move(one));
  }
  for (const AddedCause& cause : added_causes()) {
    if (!is_tried(cause.name)) continue;
    monitor::ChangeCandidate one = added_candidate(simulations, cause);
    // A dead zone of the error does in a control by the integral alone what one of the integral does.
    const bool is_known = std::ranges::any_of(candidates, [&](const monitor::ChangeCandidate& other) {
      return other.kind == one.kind && other.changes.back().machines == one.changes.back().machines &&
             one.changes.back().machines != simulations.same;
    });
    if (!is_known) candidates.push_back(std::move(one));
  }
  return candidates;
}

/// What is watched, and beside what.
struct Alarm {
  const study::Study& study;
  const monitor::ModelMoves& moves;
  const monitor::Likes& likes;
  const monitor::MoveLog& log;
  const std::vector<WatchedField>& watched;
  const trials::Effort& effort;
};

Simulations simulations_of(const Alarm& alarm, const MachineTrials& chosen) {
  return {alarm.study,  alarm.moves.point,
          chosen,       alarm.watched,
          alarm.effort, simulated(alarm.study, alarm.moves.point, chosen, alarm.watched, alarm.effort)};
}

monitor::ChangeExplanation explained(const Alarm& alarm, const Simulations& simulations,
                                     std::vector<monitor::ChangeCandidate> candidates, double plausible) {
  const auto likes = likes_of_machines(alarm.study, alarm.moves.point, simulations.chosen, alarm.likes);
  const RanksAmongLikes ranks(alarm.likes, alarm.watched, likes, simulations.same);
  for (monitor::ChangeCandidate& candidate : candidates)
    for (monitor::SimulatedChange& change : candidate.changes)
      for (std::size_t i = 0; i < likes.size(); ++i) ranks.replace(change.machines[i], likes[i]);
  const ObservedMoves observed = observed_moves(alarm.log, alarm.watched, alarm.likes, ranks);
  monitor::ChangeExplanation explanation =
      monitor::explain_change(candidates, observed.values, alarm.watched.size(), plausible);
  if (explanation.since > 1)
    explanation.since = observed.numbers[static_cast<std::size_t>(explanation.since - 1)];
  return explanation;
}

}  // namespace

std::vector<std::string> unchanged_names(const std::vector<std::string>& lists) {
  std::vector<std::string> known(scaled_names.begin(), scaled_names.end());
  for (const AddedCause& cause : added_causes()) known.emplace_back(cause.name);
  std::vector<std::string> names;
  for (const std::string& list : lists)
    for (std::size_t first = 0, end = 0; end != std::string::npos; first = end + 1) {
      end = list.find(',', first);
      names.push_back(list.substr(first, end == std::string::npos ? end : end - first));
      if (std::ranges::any_of(known, [&](const std::string& path) { return is_named(path, names.back()); }))
        continue;
      throw Failure(ExitCode::bad_input,
                    fmt::format("option '--unchanged': '{}' is not among the parameters that are tried; "
                                "expected some of {}",
                                text::printable(names.back()), fmt::join(known, ", ")));
    }
  return names;
}

monitor::ChangeExplanation explain_alarm(const reading::AllTrialsFile& file, const monitor::ModelMoves& moves,
                                         const monitor::MachineMonitor& machine, const monitor::MoveLog& log,
                                         const std::vector<std::string>& unchanged,
                                         const trials::Effort& effort) {
  const study::Study& study = file.study();
  const std::vector<Field>& fields = file.measures();
  std::vector<WatchedField> watched;
  for (const monitor::MeasureState& one : machine.measures()) {
    const auto found = std::ranges::find_if(
        fields, [&](const Field& field) { return field.column.name == one.measure.name; });
    if (found != fields.end()) watched.push_back({&*found, one.measure, one.evidence});
  }
  std::ranges::stable_sort(watched, std::greater{}, &WatchedField::evidence);
  const Alarm alarm{study, moves, machine.likes(), log, watched, effort};
  const MachineTrials all = machine_trials(study, moves, max_simulated_trials);
  const MachineTrials few = machine_trials(study, moves, max_screened_trials);
  const Simulations screening = simulations_of(alarm, few);
  std::vector<monitor::ChangeCandidate> candidates =
      candidates_of(screening, [&](std::string_view name) { return !is_unchanged(name, unchanged); });
  if (all.count() == few.count())
    return explained(alarm, screening, std::move(candidates), monitor::plausible_change);
  const monitor::ChangeExplanation screened = explained(alarm, screening, candidates, hopeless);
  if (screened.told == monitor::ChangeTold::unknown) return screened;
  const Simulations simulations = simulations_of(alarm, all);
  std::vector<monitor::ChangeCandidate> refined;
  for (const monitor::ParameterChange& one : screened.parameters) {
    refined.push_back(*std::ranges::find(candidates, one.parameter, &monitor::ChangeCandidate::parameter));
    refine(refined.back(), one, simulations);
  }
  monitor::ChangeExplanation explanation =
      explained(alarm, simulations, std::move(refined), monitor::plausible_change);
  explanation.tried = screened.tried;
  return explanation;
}

}  // namespace zerocount::result_commands
