#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/results_file.hpp"
#include "runners/verification/check.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::verification {

/// `count` different numbers from 0 to size − 1, drawn evenly, in rising order; all if there are not more.
std::vector<std::int64_t> sample_below(std::int64_t size, std::int64_t count, std::uint64_t seed);

/// The rising `rows` as ranges, each short enough for one task.
std::vector<layout::RowRange> ranges_of(std::span<const std::int64_t> rows);

/// Trials to run again.
struct ChosenTrials {
  std::vector<std::int64_t> rows;
  std::uint64_t seed{1};  ///< of the choice of failures
};

/// Runs trials of the file again with its engine, and compares everything that is stored of each: inputs,
/// measures, jerks and sample records. If the file keeps failures only, runs as many of them, drawn evenly,
/// besides the chosen rows: a trial that fails must be among the failures as it is run, and the others must
/// succeed. A file without trials gives nothing to compare.
void check_trials(CheckReport& report, const reading::ResultsFile& file, const study::Study& study,
                  const ChosenTrials& chosen, Equality equality);

}  // namespace zerocount::verification
