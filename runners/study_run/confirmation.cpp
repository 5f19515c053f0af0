#include "runners/study_run/confirmation.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include "core/failure/failure.hpp"
#include "experiments/designs/random_key.hpp"
#include "results/layout/header.hpp"
#include "runners/study_run/trial_runner.hpp"

namespace zerocount::study_run {
namespace {

constexpr std::int64_t trials_at_once = 256;
constexpr unsigned seed_bits = 52;  // readable as a double everywhere

std::uint64_t fresh_seed(std::uint64_t seed) {
  return random::random_bits({designs::random_key(seed, "confirmation"), 0}, 0, random::Draw::trial) >>
         (64U - seed_bits);
}

/// The study of the file with `trials` independent trials at each point and another seed.
study::Study fresh_study(const reading::ResultsFile& file, std::int64_t trials,
                         std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  const study::Study recorded = layout::recorded_study(file.header(), file.path(), plugin);
  if (recorded.open_loop) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: an open-loop study has no success to confirm; expected "
                              "a study with targets",
                              file.path().string()));
  }
  layout::FileHeader header = file.header();
  const auto set = [&](const std::string& key, auto value) {
    header.overrides.push_back(fmt::format("{}={}", key, value));
  };
  set("seed", fresh_seed(recorded.seed));
  const std::int64_t each = recorded.goal && recorded.rigs > 0 ? recorded.trials / recorded.rigs : 1;
  const std::int64_t least = std::max<std::int64_t>(recorded.worlds, 2);
  const std::int64_t per_world = std::max<std::int64_t>(recorded.worlds, 1);
  const std::int64_t rigs = std::max(least, trials / each / per_world * per_world);
  if (recorded.rigs == 0) trials = std::max(trials, recorded.worlds);
  if (recorded.rigs > 0) {
    set("rigs", rigs);
    trials = rigs * each;
  }
  set("trials", trials);
  set("design", "monte_carlo");
  if (recorded.stop) {
    set("stop.min_trials", trials);
    set("stop.max_trials", trials);
  }
  if (!recorded.retained_trials.empty()) set("retain", "{trials: []}");
  header.trials = trials;
  return layout::recorded_study(header, file.path(), std::move(plugin));
}

/// What is counted of the trials of `rows`.
summary_answer::Confirmation counted_in(const study::Study& study, layout::RowRange rows) {
  const std::optional<measures::CountedGoal> goal = measures::counted_goal(study);
  summary_answer::Confirmation counts;
  if (goal) counts.goal.emplace().worlds = study.worlds;
  for (const shards::TrialResult& result : TrialRunner(study).run(rows)) {
    counts.successes += trial::succeeded(result.outcome.moves) ? 1 : 0;
    if (goal)
      measures::count_moves(*counts.goal, *goal, result.row % study.trials, study.rigs, result.outcome.moves);
  }
  return counts;
}

summary_answer::Confirmation sum_of(summary_answer::Confirmation sum,
                                    const summary_answer::Confirmation& part) {
  sum.successes += part.successes;
  if (sum.goal && part.goal) *sum.goal += *part.goal;
  if (!sum.goal) sum.goal = part.goal;
  return sum;
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
  const auto count = [&](const oneapi::tbb::blocked_range<std::int64_t>& part,
                         summary_answer::Confirmation sum) {
    return sum_of(std::move(sum),
                  counted_in(study, {point * study.trials + part.begin(), part.end() - part.begin()}));
  };
  summary_answer::Confirmation confirmation =
      oneapi::tbb::parallel_reduce(oneapi::tbb::blocked_range<std::int64_t>(0, study.trials, trials_at_once),
                                   summary_answer::Confirmation{}, count, sum_of);
  confirmation.point = point;
  confirmation.seed = study.seed;
  confirmation.trials = study.trials;
  confirmation.rigs = study.rigs;
  return confirmation;
}

}  // namespace zerocount::study_run
