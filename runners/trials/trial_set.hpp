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

/// Trials whose outcomes are counted and not stored: for searches, verdicts and estimates.
namespace zerocount::trials {

/// Trials divided into blocks. One thread draws the parameters of a block's trials and runs them with one
/// engine.
struct TrialSet {
  std::int64_t count{0};  ///< Number of trials in all blocks.
  std::size_t blocks{0};
  /// Draws the parameters of a block's trials; called from any thread.
  std::function<std::vector<trial::TrialParameters>(std::size_t block)> draw;
  study::Engine engine{study::Engine::batch};
};

/// Number of trials of a block. It is at most what the SIMD lanes of the batch engine run together, and small
/// enough that all threads have equally many blocks.
/// @param all number of trials of the set
std::int64_t block_for_lanes(std::int64_t all);

/// Set of the trials 0 to count − 1 in blocks of `block` trials. `draw` gives the parameters of a trial from
/// its number.
TrialSet numbered_trials(std::int64_t count, std::int64_t block,
                         std::function<trial::TrialParameters(std::int64_t number)> draw);

/// Callback that receives the outcomes of a block, in the order of its trials. It is called once for each
/// block, from several threads.
using TakeBlock = std::function<void(std::size_t block, std::span<const trial::TrialOutcome> outcomes)>;

/// Runs the trials on all cores. The outcomes do not depend on the number of cores.
///
///     spend the trials of the effort
///     for each block, in parallel: draw, run, take(block, outcomes)
///
/// @throws Spent if the effort is not enough for all trials; then none is run
/// @throws trial::Interrupted if the time is over or a stop is requested
void run(const TrialSet& set, const Effort& effort, const TakeBlock& take);

/// [number] Result that of_outcome(outcome) gives for each trial of numbered_trials(). Runs the trials as
/// run() does.
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
