#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/header.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/trial_set.hpp"
#include "runners/trials/variant.hpp"

namespace zerocount::study_run {
namespace {

constexpr std::int64_t trials_at_once = 256;

/// The study of the file, but with `trials` independent Monte-Carlo trials at each design point, and with
/// another seed.
study::Study fresh_study(const reading::ResultsFile& file, std::int64_t trials,
                         std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  const study::Study recorded = layout::recorded_study(file.header(), file.path(), plugin);
  if (recorded.open_loop) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: an open-loop study has no success to confirm; expected "
                              "a study with targets",
                              file.path().string()));
  }
  const std::int64_t settings = recorded.settings.total();  // that each machine or draw bears
  const std::int64_t each =
      !recorded.goals.empty() && recorded.machines > 0 ? recorded.trials / recorded.machines : settings;
  const std::int64_t least = std::max<std::int64_t>(recorded.worlds, 2);
  const std::int64_t per_world = std::max<std::int64_t>(recorded.worlds, 1);
  const std::int64_t machines = std::max(least, trials / each / per_world * per_world);
  const std::int64_t draws = std::max({trials / each, recorded.worlds, std::int64_t{1}});
  const trials::Replicates fresh{recorded.machines > 0 ? machines : draws, each};
  layout::FileHeader header = file.header();
  header.trials = fresh.trials();
  header.overrides.push_back(fmt::format("seed={}", trials::fresh_seed(recorded.seed, "confirmation")));
  for (std::string& one : trials::overrides_for(recorded, fresh)) header.overrides.push_back(std::move(one));
  if (recorded.stop) {
    header.overrides.push_back(fmt::format("stop.min_trials={}", header.trials));
    header.overrides.push_back(fmt::format("stop.max_trials={}", header.trials));
  }
  return layout::recorded_study(header, file.path(), std::move(plugin));
}

/// Counts the successful trials, and for each goal the moves that meet it.
/// @param first number of the first trial of `outcomes`
summary_answer::Confirmation counted_in(const study::Study& study, std::int64_t first,
                                        std::span<const trial::TrialOutcome> outcomes) {
  const std::vector<measures::MoveCriterion> goals = measures::criteria_of_goals(study);
  summary_answer::Confirmation counts;
  counts.goals.assign(goals.size(), measures::CellCounts(measures::shape_of(study)));
  for (const trial::TrialOutcome& outcome : outcomes) {
    counts.successes += trial::succeeded(outcome.moves) ? 1 : 0;
    for (std::size_t i = 0; i < goals.size(); ++i)
      measures::count_moves(counts.goals[i], goals[i], first, outcome.moves);
    ++first;
  }
  return counts;
}

}  // namespace

summary_answer::Confirmation confirm_point(const reading::ResultsFile& file, std::int64_t point,
                                           std::int64_t trials,
                                           std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  const study::Study study = fresh_study(file, trials, std::move(plugin));
  if (study.plugin && study.plugin->functions == nullptr) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its controller is the plugin {}, which is not loaded from a results file; "
                              "expected its path with --plugin",
                              file.path().string(), study.plugin->description.name));
  }
  trials::TrialSet set = trials::numbered_trials(study.trials, trials_at_once, [&](std::int64_t index) {
    return study::study_trial(study, point, index).parameters;
  });
  set.engine = study.engine;
  std::vector<summary_answer::Confirmation> blocks(set.blocks);
  trials::run(set, {}, [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
    blocks[block] = counted_in(study, static_cast<std::int64_t>(block) * trials_at_once, outcomes);
  });
  summary_answer::Confirmation confirmation = std::move(blocks.front());
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    confirmation.successes += blocks[i].successes;
    for (std::size_t goal = 0; goal < confirmation.goals.size(); ++goal)
      confirmation.goals[goal] += blocks[i].goals[goal];
  }
  confirmation.point = point;
  confirmation.seed = study.seed;
  confirmation.trials = study.trials;
  confirmation.machines = study.machines;
  return confirmation;
}

}  // namespace zerocount::study_run
