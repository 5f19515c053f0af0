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

constexpr std::array<std::string_view, 11> candidate_names{"friction.k1",          "friction.k2",
                                                           "friction.beta",        "friction.alpha",
                                                           "friction.lambda",      "friction.breakaway",
                                                           "friction.sigma0",      "friction.sigma1",
                                                           "plant.inertia",        "plant.presliding_damping",
                                                           "plant.sliding_damping"};
constexpr std::array<double, 13> tried_factors{0.5,  0.6,  0.7,  0.8,  0.87, 0.94, 1.0,
                                               1.06, 1.15, 1.25, 1.43, 1.67, 2.0};
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

std::vector<monitor::MachineMoves> simulated(const study::Study& study, std::int64_t point,
                                             const MachineTrials& chosen,
                                             const std::vector<WatchedField>& watched,
                                             const trials::Effort& effort) {
  const auto draw = [&](std::int64_t number) {
    return study::study_trial(study, point, chosen.index(study, number)).parameters;
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
  const std::vector<monitor::MachineMoves> same = simulated(study, moves.point, chosen, watched, effort);
  std::vector<monitor::ChangeCandidate> candidates;
  for (const std::string_view name : candidate_names) {
    if (!can_be_scaled(study, moves.point, name)) continue;
    monitor::ChangeCandidate candidate{std::string(name), {}};
    for (const double factor : tried_factors) {
      if (factor == 1.0) {
        candidate.factors.push_back({factor, same});
        continue;
      }
      study::PointEdit edit(study, moves.point);
      edit.scale(name, factor);
      if (!edit.out_of_range().empty()) continue;
      candidate.factors.push_back({factor, simulated(edit.study(), moves.point, chosen, watched, effort)});
      if (candidate.factors.size() == 1 && candidate.factors[0].machines == same) break;  // it does not act
    }
    if (candidate.factors.size() > 1) candidates.push_back(std::move(candidate));
  }
  return monitor::explain_change(candidates, moves_of(log, watched), watched.size());
}

}  // namespace zerocount::result_commands
