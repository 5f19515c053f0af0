#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "analysis/trials/theory/theory_prediction.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"
#include "results/timeline/timeline.hpp"

namespace zerocount::trials {

/// Runs one trial of the study with the reference engine. Returns its data for the results file.
/// @param row number of the trial in the study, counted from 0 over all design points
/// @throws trial::Interrupted if a stop is requested before the last sample
shards::TrialResult run_study_trial(const study::Study& study, std::int64_t row,
                                    const std::stop_token& stop = {});

/// Mean number of samples of a trial, over the first trials of up to 64 design points.
double samples_per_trial(const study::Study& study);

/// Whether the SIMD lanes of the batch engine can run the first trials of up to 64 design points. False if
/// one of these trials needs the reference engine.
bool lanes_run_first_trials(const study::Study& study);

/// Number of threads to use: `asked`, or the number of processors (parallel::processors()) if `asked` is 0.
int threads_to_use(int asked);

/// Estimate of the peak memory of run_trials over the whole study, bytes.
/// @param bytes_of_trial mean of bytes_of() over trials without traces, bytes
/// @param record_bytes memory of all traces, bytes
/// @param threads number of threads; 0: all cores
double peak_memory(const study::Study& study, double bytes_of_trial, double record_bytes, int threads);

struct RunSettings {
  int threads{0};  ///< Number of threads; 0: all processors of the computer.
  /// Called by one thread at a time with the number of trials that have ended since the last call; empty: not
  /// called.
  std::function<void(std::int64_t trials)> finished{};
  timeline::Timeline* timeline{nullptr};  ///< Records the time of every stage; null: not recorded.
};

/// Results of run_trials(): the written shard files, and the predictions by theory.
struct FinishedTrials {
  /// Shards (files with the results of consecutive trials) that were written, in ascending order of rows.
  std::vector<shards::ShardInfo> shards;
  /// [design point] Predictions by theory for the trials that were run. A prediction covers no trials if the
  /// shards contain it.
  std::vector<theory::PointPrediction> predictions;
};

/// Runs the trials of `ranges` and writes them as shards (files with results of trials) into `directory`.
///
/// The points of a sweep take turns (Turns), so that at any time the finished trials compare all points.
/// Blocks of trials run in parallel. A shard ends with a turn, or when it is large enough. This bounds the
/// memory and the loss by a crash. If `stop` is requested, no new block starts, and the finished trials are
/// written.
///
///     compute    any thread: run the trials of a block, and put the kept data in columns
///     collect    one thread at a time, in the order of the turns: add the block to its shard
///
/// A shard that has ended passes through two more stages, while the next blocks run (ShardWriter):
///
///     encode     any thread: filter its columns
///     store      any thread: write the file, flush it to the disk, read it back to compare, and name it
/// @param ranges ranges of rows (numbers of the trials in the study)
FinishedTrials run_trials(const study::Study& study, std::span<const layout::RowRange> ranges,
                          const std::filesystem::path& directory, const RunSettings& settings,
                          const std::stop_token& stop);

}  // namespace zerocount::trials
