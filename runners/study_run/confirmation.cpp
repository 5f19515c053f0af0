#include "runners/study_run/confirmation.hpp"

#include <algorithm>
#include <functional>
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
  set("trials", trials);
  set("design", "monte_carlo");
  if (recorded.rigs > 0) set("rigs", trials);
  if (recorded.stop) {
    set("stop.min_trials", trials);
    set("stop.max_trials", trials);
  }
  if (!recorded.retained_trials.empty()) set("retain", "{trials: []}");
  header.trials = trials;
  return layout::recorded_study(header, file.path(), std::move(plugin));
}

std::int64_t successes_in(const study::Study& study, layout::RowRange rows) {
  const std::vector<shards::TrialResult> results = TrialRunner(study).run(rows);
  return std::count_if(results.begin(), results.end(), [](const shards::TrialResult& result) {
    return trial::succeeded(result.outcome.moves);
  });
}

}  // namespace

Confirmation confirm_point(const reading::ResultsFile& file, std::int64_t point, std::int64_t trials,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  const study::Study study = fresh_study(file, trials, std::move(plugin));
  if (study.plugin && study.plugin->functions == nullptr) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its controller is the plugin {}, which is not loaded from a results file; "
                              "expected its path with --plugin",
                              file.path().string(), study.plugin->description.name));
  }
  const auto count = [&](const oneapi::tbb::blocked_range<std::int64_t>& part, std::int64_t successes) {
    return successes + successes_in(study, {point * study.trials + part.begin(), part.end() - part.begin()});
  };
  const std::int64_t successes =
      oneapi::tbb::parallel_reduce(oneapi::tbb::blocked_range<std::int64_t>(0, trials, trials_at_once),
                                   std::int64_t{0}, count, std::plus<>());
  return {point, study.seed, trials, successes, study.rigs > 0};
}

}  // namespace zerocount::study_run
