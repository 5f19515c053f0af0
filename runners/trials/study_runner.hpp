#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "analysis/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::trials {

/// Runs one trial of the study, given by its global row, with the reference engine. Returns the data of the
/// results file.
/// @throws trial::Interrupted if a stop is requested before its last sample
shards::TrialResult run_study_trial(const study::Study& study, std::int64_t row,
                                    const std::stop_token& stop = {});

/// Number of samples of a trial: the mean over the first trials of up to 64 points.
double samples_per_trial(const study::Study& study);

/// Whether the lanes of the batch engine run the first trials of up to 64 points.
bool lanes_run_first_trials(const study::Study& study);

/// Number of threads where `asked` were asked for; 0: parallel::processors().
int threads_to_use(int asked);

/// Estimate of the peak memory of run_trials over the whole study, bytes.
/// @param bytes_of_trial mean of bytes_of(), without traces @param record_bytes bytes of all traces
/// @param threads 0: all cores
double peak_memory(const study::Study& study, double bytes_of_trial, double record_bytes, int threads);

struct RunSettings {
  int threads{0};  ///< 0: all that the machine has
  std::function<void(std::int64_t trials)>
      finished{};  ///< called by one thread at a time with the number of trials that have ended since
  timeline::Timeline* timeline{nullptr};  ///< gets a span of every stage; null: none
};

struct FinishedTrials {
  std::vector<shards::ShardInfo> shards;  ///< those written, in order of rows
  /// [point] for these trials; without trials if the shards have them
  std::vector<theory::PointPrediction> predictions;
};

/// Runs the trials of `ranges` and writes them as shards into `directory`.
///
/// The points of a sweep take turns (Turns), so that the trials so far compare all of them. Blocks of trials
/// run in parallel. A shard ends with a turn, or when it is large enough, which bounds the memory and the
/// loss by a crash. If `stop` is requested, no new block starts, and the finished trials are written.
///
///     compute    any thread: run the trials of a block, and put what is kept of them in columns
///     collect    one thread at a time, in the order of the turns: add the block to its shard
///
/// A shard that has ended passes through these beside the blocks that follow (ShardWriter):
///
///     encode     any thread: filter its columns
///     store      any thread: write the file, bring it to the disk, compare it with what was written, name it
FinishedTrials run_trials(const study::Study& study, std::span<const layout::RowRange> ranges,
                          const std::filesystem::path& directory, const RunSettings& settings,
                          const std::stop_token& stop);

}  // namespace zerocount::trials
