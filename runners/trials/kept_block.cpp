#include "runners/trials/kept_block.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

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
  const std::int64_t first_point = kept.rows.first / study.trials;
  for (std::span<const shards::TrialResult> rest(block.results); !rest.empty();) {
    const std::int64_t row = rest.front().row;
    const std::int64_t point = row / study.trials;
    const auto of_point = static_cast<std::size_t>(
        std::min((point + 1) * study.trials - row, static_cast<std::int64_t>(rest.size())));
    kept.sums.emplace_back(study, point, row % study.trials).add(rest.first(of_point));
    kept.sums.back().add(block.predictions[static_cast<std::size_t>(point - first_point)]);
    rest = rest.subspan(of_point);
  }
  if (layout::has_trials(study.retention)) {
    std::erase_if(block.results,
                  [](const shards::TrialResult& result) { return trial::succeeded(result.outcome.moves); });
    kept.trials = shards::columns_of(study, measures, block.results);
  }
  return kept;
}

}  // namespace zerocount::trials
