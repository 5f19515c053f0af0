#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "tests/support/merged_file.hpp"

namespace zerocount::testing {

/// The results of one trial, as a test specifies them, to be written to a results file.
struct TrialRecord {
  trial::TrialOutcome outcome;
  std::vector<trial::Jerk> jerks;
};

/// A made-up study with so many design points, trials and moves, with names, labels and one sweep axis. Its
/// manifest is no valid text.
study::Study plain_study(std::int64_t points, std::int64_t trials, std::int64_t moves);

/// The random results of a trial with `moves` moves, always the same for the same row. Some trials have no
/// jerks, some dozens.
TrialRecord random_trial(std::int64_t row, std::int64_t moves);

/// The random results of an open-loop trial with `moves` torque levels, always the same for the same row. In
/// some trials the motion diverges during a level; the levels after it then have no measures.
TrialRecord random_open_loop_trial(std::int64_t row, std::int64_t moves);

/// Writes the results file of `study` with these trials ([row]), by merging one shard in the folder of
/// `path`.
void write_study_file(const std::filesystem::path& path, const study::Study& study,
                      const std::vector<TrialRecord>& trials,
                      const std::vector<layout::PointColumn>& statistics = {});
void write_study_file(const std::filesystem::path& path, const study::Study& study,
                      const std::vector<TrialRecord>& trials, const testing::StatisticsOfPoints& statistics,
                      const layout::MeasureTable& measures = layout::measure_table());

}  // namespace zerocount::testing
