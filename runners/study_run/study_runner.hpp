#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// Runs one trial of the study by its global row with the reference engine, and keeps what the results file
/// keeps of it.
TrialResult run_study_trial(const Study& study, std::int64_t row);

/// Number of samples of a trial: the mean over the first trials of up to 64 points.
double samples_per_trial(const Study& study);

/// Bytes that a result takes in memory.
std::size_t bytes_of(const TrialResult& result);

/// Estimate of the peak memory of run_trials over the whole study, bytes.
/// @param bytes_of_trial mean of bytes_of(), without sample records. @param record_bytes of all sample
/// records.
/// @param threads 0: all that the machine has.
double peak_memory(const Study& study, double bytes_of_trial, double record_bytes, int threads);

struct RunSettings {
  int threads{0};  ///< 0: all that the machine has
  std::function<void(std::int64_t trials)>
      finished{};  ///< told of every block of finished trials, by the writer
};

/// Runs the trials of `ranges` and writes them as shards into `directory`.
///
/// Blocks of trials run in parallel; one of them at a time, in order of rows, is taken over by the writer. A
/// shard is written when it is large enough or old enough, so memory and the work that a crash can lose are
/// bounded. Where `stop` is requested, no new block is begun, and what is finished is written.
/// @returns the shards written, in order of rows.
std::vector<ShardInfo> run_trials(const Study& study, std::span<const RowRange> ranges,
                                  const std::filesystem::path& directory, const RunSettings& settings,
                                  std::stop_token stop);

}  // namespace zerocount
