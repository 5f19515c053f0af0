#pragma once

#include <cstddef>
#include <vector>

#include "analysis/summary/summed_point.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/trial_columns.hpp"
#include "results/shards/trial_result.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::trials {

/// Memory of a result, bytes.
std::size_t bytes_of(const shards::TrialResult& result);

/// What a shard gets of consecutive trials. Sums are computed only if it does not keep every trial: for ten
/// trials of each point, writing them would take longer than the trials, and statistics follow from the
/// trials anyway.
struct KeptBlock {
  layout::RowRange rows;
  shards::TrialColumns trials;  ///< every one, or the failures, or none
  /// [point, from that of the first trial]; empty if every trial is kept
  std::vector<summary::SummedPoint> sums;
  /// [point, from that of the first trial]; empty if the sums have them
  std::vector<theory::PointPrediction> predictions;
  bool begins_turn{false};  ///< the blocks before go into a shard, without waiting for more
};

KeptBlock reduce(const study::Study& study, TrialBlock&& block);

}  // namespace zerocount::trials
