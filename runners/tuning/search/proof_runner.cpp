#include "runners/tuning/search/proof_runner.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/trial_runner.hpp"
#include "runners/tuning/race/proof.hpp"
#include "runners/tuning/search/study_search.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t usual_machines = 500;  // at least, where the effort is enough for them

/// Smallest number of machines with which one goal can be shown to be met, if no move misses it; 0 if no
/// number can. Without machines in the study: smallest number of trials.
/// @param goal index of the goal
/// @param each trials of a machine in each setting (condition at an age)
/// @param points number of points among which a choice is made, for which the bounds allow
std::int64_t min_machines_of(const study::Study& study, std::size_t goal, std::int64_t each,
                             std::size_t points) {
  const measures::MoveCriterion criterion = measures::move_criteria_of(study)[goal];
  const bool on_machines = study.machines > 0;
  std::int64_t fewest = 0;
  for (const goal::Needs& one :
       goal::smallest_studies(study.goals[goal], on_machines, measures::asked_moves(criterion, study.moves),
                              points, study.worlds)) {
    if (!on_machines) fewest = std::max(fewest, one.trials);
    if (on_machines && one.trials <= each * one.machines && (fewest == 0 || one.machines < fewest))
      fewest = one.machines;
  }
  return fewest;
}

/// Smallest number of machines with which all goals can be shown to be met, if no move misses them.
/// @param each trials of a machine, in all settings together
/// @param points number of points among which a choice is made, for which the bounds allow
std::int64_t min_machines_of(const study::Study& study, std::int64_t each, std::size_t points) {
  std::int64_t least = std::max<std::int64_t>(study.worlds, 1);
  for (std::size_t goal = 0; goal < study.goals.size(); ++goal)
    least = std::max(least, min_machines_of(study, goal, each / study.settings.total(), points));
  return least;
}

/// Counts of one goal, scaled to `each` trials of every machine at the same success rates.
/// @param each trials of a machine, in all settings together
measures::CellCounts at_trials_each(const measures::CellCounts& counts, std::int64_t each) {
  measures::CellCounts scaled(counts.shape());
  for (std::size_t setting = 0; setting < counts.settings(); ++setting) {
    const std::vector<statistics::MachineMoves> machines = counts.sum({.setting = setting}).machines;
    for (std::size_t machine = 0; machine < machines.size(); ++machine) {
      const std::int64_t trials = each / static_cast<std::int64_t>(counts.settings());
      const auto factor = static_cast<double>(trials) / static_cast<double>(machines[machine].trials);
      scaled.add_machine(machine, setting,
                         {trials, std::llround(static_cast<double>(machines[machine].moves) * factor),
                          std::llround(static_cast<double>(machines[machine].met) * factor)});
    }
  }
  return scaled;
}

/// Smallest number of machines, with equally many trials each, that decides all goals with a probability of
/// 1/2, at the rates of the counts.
/// @param points number of points among which a choice is made, for which the bounds allow
/// @param most maximum; an eighth of it is returned if no study decides the goals
std::int64_t deciding_machines(const study::Study& study, const GoalCounts& counts, std::size_t points,
                               std::int64_t most) {
  const std::vector<goal::Needs> studies = goal::deciding_studies(study.goals, counts, points, 0.5);
  if (studies.empty()) return most / 8;
  return studies.front().machines > 0 ? studies.front().machines : studies.front().trials;
}

std::string_view key_of(std::string_view entry) {
  return entry.substr(0, entry.find('='));
}

/// The "key=value" entries without those that a later entry with the same key replaces.
std::vector<std::string> last_of_each(const std::vector<std::string>& entries) {
  std::vector<std::string> kept;
  for (auto one = entries.begin(); one != entries.end(); ++one) {
    const auto again = [one](const std::string& later) { return key_of(later) == key_of(*one); };
    if (std::none_of(one + 1, entries.end(), again)) kept.push_back(*one);
  }
  return kept;
}

bool holds_run(const std::filesystem::path& output, const study::Study& study) {
  std::error_code error;
  if (!std::filesystem::exists(output, error)) return false;
  try {
    const reading::ResultsFile file(output);
    return file.header().study_sha256 == study.study_sha256 &&
           layout::same_build(file.header().provenance, layout::current_provenance());
  } catch (const Failure&) {
    return false;  // no results file: it is made anew
  }
}

void make_run(const study::Study& study, const std::filesystem::path& output, int threads,
              const trials::Effort& effort) {
  try {
    study_run::run_to_file({study,
                            output,
                            layout::all_rows(study),
                            threads,
                            true,
                            study_run::ForeignShards::remove,
                            true,
                            {},
                            parallel::recording()},
                           study_run::ExistingUse::none, effort.stop());
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::interrupted || effort.is_interrupted()) throw;
    std::error_code error;
    std::filesystem::remove_all(layout::shards_directory(output), error);
    throw trials::Spent{};
  }
}

}  // namespace

GoalCounts counts_of(const study::Study& study, const trials::Replicates& machines,
                     std::span<const MachineResult> results) {
  const auto settings = static_cast<std::size_t>(study.settings.total());
  measures::Shape shape = measures::shape_of(study);
  if (shape.machines > 0) shape.machines = std::ssize(results);
  GoalCounts goals(study.goals.size(), measures::CellCounts(shape));
  for (std::size_t goal = 0; goal < goals.size(); ++goal) {
    measures::CellCounts& counts = goals[goal];
    for (std::size_t machine = 0; machine < results.size(); ++machine) {
      for (std::size_t setting = 0; setting < settings; ++setting) {
        const ClaimResult& claim = results[machine].claims[goal * settings + setting];
        const auto number = static_cast<std::int64_t>(machine);
        if (study.machines == 0) {
          counts.add(trials::trial_of_replicate(study, machines, number, static_cast<std::int64_t>(setting)),
                     claim.moves, claim.met);
        } else {
          counts.add_machine(
              machine, setting,
              {machines.trials_each / static_cast<std::int64_t>(settings), claim.moves, claim.met});
        }
      }
    }
  }
  return goals;
}

std::vector<std::string> confidences_of_attempt(const study::Study& study, int attempt) {
  std::vector<std::string> confidences;
  for (const study::Goal& goal : study.goals) {
    const std::string key = goal.name.empty() ? "goal" : "goals." + goal.name;
    confidences.push_back(fmt::format(
        "{}.confidence={}", key, statistics::confidence_of_each(goal.confidence, correction_of(attempt))));
  }
  return confidences;
}

Judged judged(const study::Study& study, const trials::Replicates& machines,
              std::span<const MachineResult> results) {
  Judged judged{counts_of(study, machines, results), {}};
  judged.verdict = goal::judge_goals(study.goals, judged.counts, 1);
  judged.criterion = estimate_of(aim_of(study), results, machines.count).criterion;
  return judged;
}

GoalCounts with_trials_each(GoalCounts counts, std::int64_t each) {
  if (counts.front().shape().machines == 0) return counts;
  for (measures::CellCounts& goal : counts) goal = at_trials_each(goal, each);
  return counts;
}

std::int64_t proof_machines(const study::Study& study, const GoalCounts& counts, std::int64_t each,
                            std::size_t points, std::int64_t max_trials) {
  const std::int64_t worlds = std::max<std::int64_t>(study.worlds, 1);
  const std::int64_t most = std::max<std::int64_t>(max_trials / each / worlds, 1) * worlds;
  const std::int64_t least = std::max(usual_machines, min_machines_of(study, each, points));
  std::int64_t wanted = deciding_machines(study, counts, points, most);
  wanted += wanted / 2;
  return trials::in_equal_worlds(study, std::clamp(wanted, std::min(least, most), most));
}

std::int64_t min_proof_trials(const study::Study& study, int attempt) {
  const std::int64_t each = trials_of_machine(study);
  return trials::in_equal_worlds(study, min_machines_of(study, each, correction_of(attempt))) * each;
}

study::Study with_values_in_text(const study::Study& study, const std::vector<std::string>& values) {
  std::vector<std::string> all = study.manifest.overrides;
  all.insert(all.end(), values.begin(), values.end());
  std::string text = study.manifest.text;
  std::vector<std::string> overrides;
  for (const std::string& one : last_of_each(all)) {
    const std::string_view key = key_of(one);
    const std::optional<std::string> edited =
        manifest_text::with_override(text, key, std::string_view(one).substr(key.size() + 1));
    if (edited) {
      text = *edited;
    } else {
      overrides.push_back(one);
    }
  }
  study::Study edited =
      manifest::parse_study(text, study.name, overrides, sections::external_inputs_of(study));
  edited.engine = study.engine;
  return edited;
}

ProofRun run_proof(const study::Study& study, std::vector<std::string> values,
                   const trials::Replicates& machines, const std::filesystem::path& output, int threads,
                   const trials::Effort& effort) {
  effort.spend(machines.trials());
  for (const std::string& one : trials::overrides_for(study, machines)) values.push_back(one);
  if (layout::has_sums(study.retention)) values.emplace_back("keep=trials");
  ProofRun run{with_values_in_text(study, values), {}};
  run.study.engine = trials::engine_that_runs(run.study);
  if (!holds_run(output, run.study)) make_run(run.study, output, threads, effort);
  run.results = results_in(reading::AllTrialsFile(output), run.study, machines);
  return run;
}

}  // namespace zerocount::tuning
