#include "runners/result_commands/changed_parameters.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/study/point_edit.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/fields.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::result_commands {
namespace {

using monitor::ChangeKind;
using Machines = std::vector<monitor::MachineMoves>;

/// A parameter that may have changed. One that is 0 in most studies is added to, others are multiplied.
struct Cause {
  std::string_view name;
  std::string_view unit{};
  std::vector<double> changes{0.5,  0.6,  0.7,  0.8,  0.87, 0.94, 1.0,
                              1.06, 1.15, 1.25, 1.43, 1.67, 2.0};  ///< rising, that of no change among them
  void (*add)(trial::TrialParameters& parameters, double amount){nullptr};  ///< null: it is multiplied

  ChangeKind kind() const { return add == nullptr ? ChangeKind::factor : ChangeKind::amount; }
};

/// Widens a zone of errors, which negative bounds switch off.
void widen(double& bound, double amount) {
  bound = std::max(bound, 0.0) + amount;
}

const std::vector<Cause>& all_causes() {
  using Trial = trial::TrialParameters;
  static const std::vector<double> whole_counts{0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0};
  static const std::vector<Cause> causes{
      {"friction.k1"},
      {"friction.k2"},
      {"friction.beta"},
      {"friction.alpha"},
      {"friction.lambda"},
      {"friction.breakaway"},
      {"friction.sigma0"},
      {"friction.sigma1"},
      {"plant.inertia"},
      {"plant.presliding_damping"},
      {"plant.sliding_damping"},
      {"controller.kp"},
      {"controller.ki"},
      {"controller.kd"},
      {"amplifier.bandwidth"},
      {"encoder.fine_errors.noise",
       "count",
       {0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8},
       // Where the load's encoder closes the loop, it has changed places with the motor's.
       [](Trial& p, double amount) {
         const bool exchanged =
             loop::has_other(p.encoder) && p.plant.load.encoder == motion::EncoderPlace::load;
         (exchanged ? p.encoder.other.errors : p.encoder.fine_errors).noise += amount;
       }},
      // Factors of the torque less one: the gain error stays above -1.
      {"dac.gain_error",
       "",
       {-0.5, -0.4, -0.3, -0.2, -0.13, -0.06, 0.0, 0.06, 0.15, 0.25, 0.43, 0.67, 1.0},
       [](Trial& p, double amount) { p.dac.gain_error += amount * (1.0 + p.dac.gain_error); }},
      {"controller.delay",
       "sample",
       {0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0},
       [](Trial& p, double amount) { p.controller.delay += amount; }},
      {"controller.deadband.enter", "count", whole_counts,
       [](Trial& p, double amount) { widen(p.controller.blocks.deadband.enter, amount); }},
      {"controller.error_deadband.band", "count", whole_counts,
       [](Trial& p, double amount) { widen(p.controller.blocks.error_deadband.band, amount); }}};
  return causes;
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

constexpr std::int64_t max_simulated_machines = 64;
constexpr std::int64_t max_simulated_trials = 1024;
/// The changes that are far less likely than others are simulated with fewer trials.
constexpr std::int64_t max_screened_trials = 256;
constexpr double hopeless = 1e-4;  // probability

struct WatchedField {
  const layout::RecordField<trial::MoveOutcome>* field;
  monitor::MonitoredMeasure measure;
  double evidence;  ///< of its change
};

/// What an alarm is about.
struct Alarm {
  const study::Study& study;
  const monitor::ModelMoves& moves;
  const monitor::Likes& likes;
  const monitor::MoveLog& log;
  const std::vector<WatchedField>& watched;
  const trials::Effort& effort;
};

/// The moves of simulated machines (rigs, without rigs trials) with each change, by at most so many trials.
class Simulations {
 public:
  Simulations(const Alarm& alarm, std::int64_t max_trials) : of_(alarm) {
    const std::int64_t all = alarm.study.rigs > 0 ? alarm.study.rigs : alarm.study.trials;
    machines_ = alarm.moves.rig ? 1 : std::min(all, max_simulated_machines);
    trials_of_machine_ = most_trials_of_machine(max_trials);
    same_ = simulated(alarm.study, [](trial::TrialParameters&) {});
  }

  /// Whether these are all trials of the machines up to so many.
  bool has_all(std::int64_t max_trials) const {
    return trials_of_machine_ == most_trials_of_machine(max_trials);
  }
  const Machines& same() const { return same_; }

  /// The moves with the change; nothing where the parameter would leave its range.
  std::optional<Machines> changed(const Cause& cause, double change) const {
    if (change == monitor::unchanged_by(cause.kind())) return same_;
    if (cause.kind() == ChangeKind::amount)
      return simulated(of_.study, [&](trial::TrialParameters& drawn) { cause.add(drawn, change); });
    study::PointEdit edit(of_.study, of_.moves.point);
    edit.scale(cause.name, change);
    if (!edit.out_of_range().empty()) return std::nullopt;
    return simulated(edit.study(), [](trial::TrialParameters&) {});
  }

  /// What the moves of the log say of the candidates.
  monitor::ChangeExplanation explained(std::vector<monitor::ChangeCandidate> candidates,
                                       double plausible) const;

 private:
  std::int64_t trials() const { return machines_ * trials_of_machine_; }
  std::int64_t most_trials_of_machine(std::int64_t max_trials) const {
    if (of_.study.rigs == 0) return 1;
    return std::min(of_.study.trials / of_.study.rigs, std::max<std::int64_t>(1, max_trials / machines_));
  }
  /// The trial of the point with this number among those that are simulated.
  std::int64_t index(std::int64_t number) const {
    const std::int64_t machine = of_.moves.rig.value_or(number / trials_of_machine_);
    return machine + of_.study.rigs * (number % trials_of_machine_);
  }

  /// @param change of the drawn parameters
  Machines simulated(const study::Study& study,
                     const std::function<void(trial::TrialParameters&)>& change) const {
    constexpr std::int64_t trials_of_block = 64;
    const auto draw = [&](std::int64_t number) {
      trial::TrialParameters drawn = study::study_trial(study, of_.moves.point, index(number)).parameters;
      change(drawn);
      return drawn;
    };
    const auto values = trials::results_of(
        trials(), trials_of_block, draw, of_.effort, [&](const trial::TrialOutcome& outcome) {
          monitor::MachineMoves moves;
          for (const trial::MoveOutcome& move : outcome.moves)
            for (const WatchedField& one : of_.watched)
              moves.push_back(monitor::ranked_value(one.measure, layout::value_of(*one.field, move)));
          return moves;
        });
    Machines machines(static_cast<std::size_t>(machines_));
    for (std::size_t i = 0; i < values.size(); ++i) {
      monitor::MachineMoves& machine = machines[i / static_cast<std::size_t>(trials_of_machine_)];
      machine.insert(machine.end(), values[i].begin(), values[i].end());
    }
    return machines;
  }

  const Alarm& of_;
  std::int64_t machines_;
  std::int64_t trials_of_machine_;
  Machines same_;  ///< without a change
};

/// Replaces the values of each machine's moves by their ranks among the unchanged moves like them, so that
/// moves of different targets are alike. Without likes the values stay.
class RanksAmongLikes {
 public:
  /// @param likes [machine][move] @param unchanged [machine]
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

  void replace(monitor::MachineMoves& moves, const std::vector<std::size_t>& likes) const {
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
  std::vector<std::vector<double>> sorted_;  ///< [like][measure]
};

monitor::ChangeExplanation Simulations::explained(std::vector<monitor::ChangeCandidate> candidates,
                                                  double plausible) const {
  std::vector<std::vector<std::size_t>> likes(static_cast<std::size_t>(machines_));  // [machine][move]
  for (std::int64_t number = 0; number < trials(); ++number)
    for (const monitor::MoveLabel& label :
         monitor::labels_of(study::commanded_trial(of_.study, of_.moves.point, index(number)).parameters))
      likes[static_cast<std::size_t>(number / trials_of_machine_)].push_back(
          of_.likes.of_own(label).value_or(0));
  const RanksAmongLikes ranks(of_, likes, same_);
  for (monitor::ChangeCandidate& candidate : candidates)
    for (monitor::SimulatedChange& change : candidate.changes)
      for (std::size_t i = 0; i < likes.size(); ++i) ranks.replace(change.machines[i], likes[i]);

  std::vector<std::int64_t> numbers;  // in the log, from 1, of the moves that have a like
  std::vector<std::size_t> likes_of_log;
  monitor::MachineMoves observed;
  for (std::size_t move = 0; move < static_cast<std::size_t>(of_.log.moves); ++move) {
    const std::optional<std::size_t> like = of_.likes.of(of_.log.labels.of(move));
    if (!like || !ranks.knows(*like)) continue;
    numbers.push_back(static_cast<std::int64_t>(move) + 1);
    likes_of_log.push_back(*like);
    for (const WatchedField& one : of_.watched)
      observed.push_back(of_.log.find(one.measure.name)->values[move]);
  }
  ranks.replace(observed, likes_of_log);
  monitor::ChangeExplanation explanation =
      monitor::explain_change(candidates, observed, of_.watched.size(), plausible);
  if (explanation.since > 1) explanation.since = numbers[static_cast<std::size_t>(explanation.since - 1)];
  return explanation;
}

/// The candidates that act on what is watched, of those that may have changed.
std::vector<monitor::ChangeCandidate> candidates_of(const Simulations& simulations, const Alarm& alarm,
                                                    const std::vector<std::string>& unchanged) {
  std::vector<monitor::ChangeCandidate> candidates;
  for (const Cause& cause : all_causes()) {
    const bool scaled = cause.kind() == ChangeKind::factor;
    if (std::ranges::any_of(unchanged, [&](const auto& name) { return is_named(cause.name, name); }))
      continue;
    if (scaled) {
      const study::ValueLimits limits = study::PointEdit(alarm.study, alarm.moves.point).limits(cause.name);
      if (limits.low == 0.0 && limits.high == 0.0) continue;
    }
    monitor::ChangeCandidate one{std::string(cause.name), {}, cause.kind(), std::string(cause.unit)};
    const auto acts = [&](const monitor::SimulatedChange& change) {
      return change.machines != simulations.same();
    };
    for (const double change : cause.changes) {
      if (auto moves = simulations.changed(cause, change)) one.changes.push_back({change, std::move(*moves)});
      // A factor of what is 0, or does not act, changes nothing.
      if (scaled && one.changes.size() == 1 && !acts(one.changes[0])) break;
    }
    // A dead zone of the error does in a control by the integral alone what one of the integral does.
    const bool is_known =
        !scaled && std::ranges::any_of(candidates, [&](const monitor::ChangeCandidate& other) {
          return other.kind == one.kind && other.changes.back().machines == one.changes.back().machines &&
                 acts(one.changes.back());
        });
    if (!is_known && one.changes.size() > 1) candidates.push_back(std::move(one));
  }
  return candidates;
}

/// Simulates the changes of the interval, and the next one on each side, with these trials.
void refine(monitor::ChangeCandidate& candidate, const monitor::ParameterChange& interval,
            const Simulations& simulations) {
  std::vector<monitor::SimulatedChange>& changes = candidate.changes;
  const Cause& cause = *std::ranges::find(all_causes(), candidate.parameter, &Cause::name);
  const auto at = [&](double change) {
    return std::ranges::lower_bound(changes, change, {}, &monitor::SimulatedChange::change) - changes.begin();
  };
  const std::ptrdiff_t first = at(interval.low) - 1;
  const std::ptrdiff_t last = std::min(std::ssize(changes) - 1, at(interval.high) + 1);
  for (std::ptrdiff_t i = 0; i < std::ssize(changes); ++i) {
    monitor::SimulatedChange& change = changes[static_cast<std::size_t>(i)];
    if (change.change != monitor::unchanged_by(candidate.kind) && (i < first || i > last)) continue;
    if (auto moves = simulations.changed(cause, change.change)) change.machines = std::move(*moves);
  }
}

}  // namespace

std::vector<std::string> unchanged_names(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists)
    for (std::size_t first = 0, end = 0; end != std::string::npos; first = end + 1) {
      end = list.find(',', first);
      names.push_back(list.substr(first, end == std::string::npos ? end : end - first));
      if (std::ranges::any_of(all_causes(),
                              [&](const Cause& one) { return is_named(one.name, names.back()); }))
        continue;
      std::vector<std::string_view> known;
      for (const Cause& cause : all_causes()) known.push_back(cause.name);
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
  std::vector<WatchedField> watched;
  for (const monitor::MeasureState& one : machine.measures())
    for (const auto& field : file.measures())
      if (field.column.name == one.measure.name) watched.push_back({&field, one.measure, one.evidence});
  std::ranges::stable_sort(watched, std::greater{}, &WatchedField::evidence);
  const Alarm alarm{file.study(), moves, machine.likes(), log, watched, effort};
  const Simulations screening(alarm, max_screened_trials);
  std::vector<monitor::ChangeCandidate> candidates = candidates_of(screening, alarm, unchanged);
  if (screening.has_all(max_simulated_trials))
    return screening.explained(std::move(candidates), monitor::plausible_change);
  const monitor::ChangeExplanation screened = screening.explained(candidates, hopeless);
  if (screened.told == monitor::ChangeTold::unknown) return screened;
  const Simulations simulations(alarm, max_simulated_trials);
  std::vector<monitor::ChangeCandidate> refined;
  for (const monitor::ParameterChange& one : screened.parameters) {
    refined.push_back(*std::ranges::find(candidates, one.parameter, &monitor::ChangeCandidate::parameter));
    refine(refined.back(), one, simulations);
  }
  monitor::ChangeExplanation explanation =
      simulations.explained(std::move(refined), monitor::plausible_change);
  explanation.tried = screened.tried;
  return explanation;
}

}  // namespace zerocount::result_commands
