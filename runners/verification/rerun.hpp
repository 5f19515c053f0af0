#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"
#include "results/reading/statistics_file.hpp"
#include "results/reading/study_file.hpp"
#include "runners/verification/check.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::verification {

/// `count` different numbers from 0 to size − 1, drawn evenly, in rising order; all if there are not more.
std::vector<std::int64_t> sample_below(std::int64_t size, std::int64_t count, std::uint64_t seed);

/// The rising `rows` as ranges, each short enough for one task.
std::vector<layout::RowRange> ranges_of(std::span<const std::int64_t> rows);

/// Runs the trials `rows` of the file again with its engine, and compares all that is stored of each: inputs,
/// measures, jerks and sample records.
void check_trials(CheckReport& report, const reading::StudyFile& file, const study::Study& study,
                  std::span<const std::int64_t> rows, Equality equality);

/// The same of a file of statistics, with as many of its failures, drawn evenly, besides `rows`: a trial that
/// fails must be among the failures as it is run, and the others must succeed. Of a file without failures
/// there is nothing to compare.
void check_kept_trials(CheckReport& report, const reading::StatisticsFile& file, const study::Study& study,
                       std::span<const std::int64_t> rows, std::uint64_t seed, Equality equality);

}  // namespace zerocount::verification
