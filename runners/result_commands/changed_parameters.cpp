#include "runners/result_commands/changed_parameters.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

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
          {"controller.delay", "sample", {0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0}, [](Trial& p, double amount) {
             p.controller.delay += amount;
           }}};
}

constexpr std::int64_t max_simulated_machines = 64;
constexpr std::int64_t max_simulated_trials = 1024;
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

MachineTrials machine_trials(const study::Study& study, const monitor::ModelMoves& moves) {
  MachineTrials chosen;
  const std::int64_t all = study.rigs > 0 ? study.rigs : study.trials;
  if (moves.rig) {
    chosen.machines = {*moves.rig};
  } else {
    for (std::int64_t i = 0; i < std::min(all, max_simulated_machines); ++i) chosen.machines.push_back(i);
  }
  if (study.rigs > 0) {
    const std::int64_t most = std::max<std::int64_t>(1, max_simulated_trials / std::ssize(chosen.machines));
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

/// With one change alone if the parameter does not act on what is watched.
monitor::ChangeCandidate scaled_candidate(const Simulations& of, std::string_view name) {
  monitor::ChangeCandidate candidate{std::string(name), {}};
  for (const double factor : tried_factors) {
    if (factor == 1.0) {
      candidate.changes.push_back({factor, of.same});
      continue;
    }
    study::PointEdit edit(of.study, of.point);
    edit.scale(name, factor);
    if (!edit.out_of_range().empty()) continue;
    candidate.changes.push_back(
        {factor, simulated(edit.study(), of.point, of.chosen, of.watched, of.effort)});
    if (candidate.changes.size() == 1 && candidate.changes[0].machines == of.same) break;
  }
  return candidate;
}

monitor::ChangeCandidate added_candidate(const Simulations& of, const AddedCause& cause) {
  monitor::ChangeCandidate candidate{
      std::string(cause.name), {}, monitor::ChangeKind::amount, std::string(cause.unit)};
  for (const double amount : cause.amounts) {
    candidate.changes.push_back(
        {amount, amount == 0.0 ? of.same
                               : simulated(of.study, of.point, of.chosen, of.watched, of.effort,
                                           [&](trial::TrialParameters& p) { cause.add(p, amount); })});
  }
  return candidate;
}

/// The values of the watched measures, move after move.
monitor::MachineMoves moves_of(const monitor::MoveLog& log, const std::vector<WatchedField>& watched) {
  monitor::MachineMoves moves;
  for (std::size_t move = 0; move < static_cast<std::size_t>(log.moves()); ++move)
    for (const WatchedField& one : watched) moves.push_back(log.find(one.measure.name)->values[move]);
  return moves;
}

}  // namespace

monitor::ChangeExplanation explain_alarm(const reading::AllTrialsFile& file, const monitor::ModelMoves& moves,
                                         const monitor::MachineMonitor& machine, const monitor::MoveLog& log,
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
  const MachineTrials chosen = machine_trials(study, moves);
  const Simulations simulations{study,   moves.point, chosen,
                                watched, effort,      simulated(study, moves.point, chosen, watched, effort)};
  std::vector<monitor::ChangeCandidate> candidates;
  for (const std::string_view name : scaled_names) {
    if (!can_be_scaled(study, moves.point, name)) continue;
    monitor::ChangeCandidate one = scaled_candidate(simulations, name);
    if (one.changes.size() > 1) candidates.push_back(std::move(one));
  }
  for (const AddedCause& cause : added_causes()) {
    monitor::ChangeCandidate one = added_candidate(simulations, cause);
    if (one.changes.size() > 1) candidates.push_back(std::move(one));
  }
  return monitor::explain_change(candidates, moves_of(log, watched), watched.size());
}

}  // namespace zerocount::result_commands
