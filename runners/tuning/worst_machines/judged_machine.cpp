#include "runners/tuning/worst_machines/judged_machine.hpp"

#include <algorithm>

#include "analysis/measures/goal_counts.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/plan.hpp"
#include "runners/trials/trial_set.hpp"
#include "runners/tuning/worst_machines/machine_race.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t judged_at_once = 64;

/// What a trial shows of all goals together, then of each.
std::vector<ClaimResult> counts_of(const trial::TrialOutcome& outcome, const study::Study& study,
                                   const MachineFailures& failures) {
  std::vector<ClaimResult> counts(1);
  failures.add_to(counts.front(), {&outcome, 1});
  for (const measures::CountedGoal& goal : measures::asked_of_moves(study)) {
    ClaimResult& count = counts.emplace_back();
    for (const trial::MoveOutcome& move : outcome.moves) {
      if (!measures::asks(goal, move)) continue;
      ++count.moves;
      count.met += measures::meets(goal, move) ? 1 : 0;
    }
  }
  return counts;
}

std::vector<ClaimResult> sum_of(const std::vector<std::vector<ClaimResult>>& trials) {
  std::vector<ClaimResult> sums(trials.front().size());
  for (const std::vector<ClaimResult>& trial : trials) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i].moves += trial[i].moves;
      sums[i].met += trial[i].met;
      sums[i].values.insert(sums[i].values.end(), trial[i].values.begin(), trial[i].values.end());
    }
  }
  return sums;
}

/// The trials of the machine's manifest.
/// @throws Failure where no manifest describes it
std::vector<trial::TrialParameters> trials_of_manifest(const JudgedMachine& machine, const MachineBox& box,
                                                       std::int64_t first, std::int64_t step,
                                                       std::int64_t count) {
  const study::Study alone =
      manifest::parse_study(machine.manifest, box.study().name, {}, sections::companions_of(box.study()));
  std::vector<trial::TrialParameters> trials;
  for (std::int64_t i = 0; i < count; ++i)
    trials.push_back(study::study_trial(alone, 0, first + i * step).parameters);
  return trials;
}

}  // namespace

JudgedMachine judged(const BoxPoint& point, const MachineBox& box, const MachineFailures& failures,
                     const MachineManifest& manifest, const trials::Effort& effort) {
  const study::Study& study = box.study();
  JudgedMachine machine;
  machine.rig = point.rig;
  machine.quantiles = point.quantiles;
  for (std::size_t i = 0; i < box.inputs().size(); ++i) {
    for (const auto& one : study::values_at_quantile(study, box.point(), box.inputs()[i], point.quantiles[i]))
      machine.inputs.push_back(one);
  }
  const std::int64_t step = rigs_of_manifest(box, point);
  std::vector<trial::TrialParameters> trials;
  std::int64_t first = 0;
  try {
    machine.manifest = manifest_of(box, point, machine.inputs, manifest);
    first = box.has_profile_per_rig() ? point.rig : 0;
    trials = trials_of_manifest(machine, box, first, step, manifest.trials);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::bad_input && failure.code() != ExitCode::bad_data) throw;
    machine.manifest.clear();
    machine.no_manifest = failure.what();
    for (std::int64_t i = 0; i < manifest.trials; ++i)
      trials.push_back(box.trial_of(point, study.trials + stage_trials.back() + i));
  }
  const std::vector<std::vector<ClaimResult>> results = trials::results_of(
      manifest.trials, judged_at_once, [&](std::int64_t i) { return trials[static_cast<std::size_t>(i)]; },
      effort, [&](const trial::TrialOutcome& outcome) { return counts_of(outcome, study, failures); });
  const std::vector<ClaimResult> sums = sum_of(results);
  const ClaimResult& result = sums.front();
  machine.moves = result.moves;
  machine.met = met_proportion(result);
  if (sums.size() > 2) {
    const auto worst = std::ranges::min_element(sums.begin() + 1, sums.end(), {}, met_proportion);
    machine.goal = goal_name(study, {static_cast<std::size_t>(worst - sums.begin() - 1), 0});
  }
  const auto last = std::ranges::max_element(result.values) - result.values.begin();
  const std::int64_t asked = result.moves / manifest.trials;
  machine.trial = first + last / asked * step;
  return machine;
}

}  // namespace zerocount::tuning
