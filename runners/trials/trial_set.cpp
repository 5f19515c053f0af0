#include "runners/trials/trial_set.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::trials {

std::int64_t block_for_lanes(std::int64_t all) {
  constexpr std::int64_t most = 128;  // the lanes of an engine
  constexpr std::int64_t least = 16;
  const std::int64_t threads = parallel::threads();
  const std::int64_t blocks_of_thread =
      std::max<std::int64_t>((all + most * threads - 1) / (most * threads), 1);
  const std::int64_t blocks = blocks_of_thread * threads;
  return std::max((all + blocks - 1) / blocks, least);
}

TrialSet numbered_trials(std::int64_t count, std::int64_t block,
                         std::function<trial::TrialParameters(std::int64_t number)> draw) {
  const auto draw_block = [count, block, draw = std::move(draw)](std::size_t number) {
    const std::int64_t first = static_cast<std::int64_t>(number) * block;
    std::vector<trial::TrialParameters> trials;
    for (std::int64_t i = first; i < std::min(first + block, count); ++i) trials.push_back(draw(i));
    return trials;
  };
  return {count, static_cast<std::size_t>((count + block - 1) / block), draw_block, study::Engine::batch};
}

namespace {

std::vector<trial::TrialOutcome> outcomes_of(std::span<const trial::TrialParameters> trials,
                                             batch::BatchEngine& engine, const std::stop_token& stop) {
  std::vector<const trial::TrialParameters*> parameters;
  parameters.reserve(trials.size());
  for (const trial::TrialParameters& one : trials) parameters.push_back(&one);
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  engine.run(parameters, outcomes, {.jerk = {}, .sample = {}, .stop = stop});
  return outcomes;
}

std::vector<trial::TrialOutcome> outcomes_by_reference(std::span<const trial::TrialParameters> trials,
                                                       const std::stop_token& stop) {
  std::vector<trial::TrialOutcome> outcomes;
  for (const trial::TrialParameters& one : trials)
    outcomes.push_back(trial::run_trial(one, {.sample = {}, .jerk = {}, .stop = stop}));
  return outcomes;
}

}  // namespace

void run(const TrialSet& set, const Effort& effort, const TakeBlock& take) {
  effort.spend(set.count);
  const std::stop_token stop = effort.stop();
  oneapi::tbb::enumerable_thread_specific<std::unique_ptr<batch::BatchEngine>> engines(
      [] { return std::make_unique<batch::BatchEngine>(); });
  parallel::for_each_index(
      set.blocks,
      [&](std::size_t block) {
        const std::vector<trial::TrialParameters> trials = set.draw(block);
        take(block, set.engine == study::Engine::reference ? outcomes_by_reference(trials, stop)
                                                           : outcomes_of(trials, *engines.local(), stop));
      },
      "simulate");
}

}  // namespace zerocount::trials
