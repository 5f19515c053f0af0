#include "runners/trials/kept_block.hpp"

#include <cstdint>
#include <utility>

#include "results/layout/header.hpp"

namespace zerocount::trials {

std::size_t bytes_of(const shards::TrialResult& result) {
  return sizeof result + result.inputs.size() * sizeof(double) +
         result.outcome.moves.size() * sizeof(trial::MoveOutcome) +
         result.jerks.size() * sizeof(trial::Jerk) + result.trace.size() * sizeof(trial::SampleRecord);
}

KeptBlock reduce(const study::Study& study, TrialBlock&& block) {
  const layout::MeasureTable& measures = layout::measure_table(study.features);
  KeptBlock kept{{block.results.front().row, std::ssize(block.results)}, {}, {}, {}};
  if (!layout::has_sums(study.retention)) {
    kept.trials = shards::columns_of(study, measures, block.results);
    kept.predictions = std::move(block.predictions);
    return kept;
  }
  std::vector<shards::TrialResult> failures;
  for (shards::TrialResult& result : block.results) {
    const std::int64_t point = result.row / study.trials;
    if (kept.sums.empty() || kept.sums.back().point() != point)
      kept.sums.emplace_back(study, point, result.row % study.trials);
    kept.sums.back().add(result.row, result.outcome, result.jerks);
    if (layout::has_trials(study.retention) && !trial::succeeded(result.outcome.moves))
      failures.push_back(std::move(result));
  }
  if (layout::has_trials(study.retention)) kept.trials = shards::columns_of(study, measures, failures);
  for (std::size_t i = 0; i < kept.sums.size(); ++i) kept.sums[i].add(block.predictions[i]);
  return kept;
}

}  // namespace zerocount::trials
