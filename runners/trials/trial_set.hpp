#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/sampling.hpp"
#include "runners/trials/effort.hpp"

/// Trials that are run to be counted and not stored: for searches, verdicts and estimates.
namespace zerocount::trials {

/// Trials in blocks. One thread draws a block, and runs it with one engine.
struct TrialSet {
  std::int64_t count{0};  ///< trials of all blocks
  std::size_t blocks{0};
  std::function<std::vector<trial::TrialParameters>(std::size_t block)> draw;  ///< called from any thread
  study::Engine engine{study::Engine::batch};
};

/// Trials of a block: at most those that lanes run together, and few enough that all threads have as many
/// blocks. @param all trials of the set
std::int64_t block_for_lanes(std::int64_t all);

/// The trials 0 to count − 1, each drawn by its number, in blocks of `block` trials.
TrialSet numbered_trials(std::int64_t count, std::int64_t block,
                         std::function<trial::TrialParameters(std::int64_t number)> draw);

/// Gets the outcomes of a block, in the order of its trials; once for each block, from several threads.
using TakeBlock = std::function<void(std::size_t block, std::span<const trial::TrialOutcome> outcomes)>;

/// Runs the trials on all cores. The outcomes do not depend on the number of cores.
///
///     spend the trials of the effort
///     for each block, in parallel: draw, run, take(block, outcomes)
///
/// @throws Spent where the effort is not enough for all trials: then none is run
/// @throws trial::Interrupted where the time is over or a stop is requested
void run(const TrialSet& set, const Effort& effort, const TakeBlock& take);

/// What `of_outcome` makes of the outcome of each numbered trial, [number]; as run().
template <class OfOutcome>
auto results_of(std::int64_t count, std::int64_t block,
                const std::function<trial::TrialParameters(std::int64_t number)>& draw, const Effort& effort,
                const OfOutcome& of_outcome) {
  std::vector<decltype(of_outcome(trial::TrialOutcome{}))> results(static_cast<std::size_t>(count));
  run(numbered_trials(count, block, draw), effort,
      [&](std::size_t number, std::span<const trial::TrialOutcome> outcomes) {
        std::size_t next = number * static_cast<std::size_t>(block);
        for (const trial::TrialOutcome& outcome : outcomes) results[next++] = of_outcome(outcome);
      });
  return results;
}

}  // namespace zerocount::trials
