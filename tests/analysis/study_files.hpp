#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "tests/support/merged_file.hpp"

namespace zerocount::testing {

/// What a test says of one trial.
struct TrialRecord {
  trial::TrialOutcome outcome;
  std::vector<trial::Jerk> jerks;
};

/// A study of this size without a manifest that could be read: names, labels and one axis.
study::Study plain_study(std::int64_t points, std::int64_t trials, std::int64_t moves);

/// Some trial with `moves` moves: random, a function of the row alone. Some have no jerks, some dozens.
TrialRecord random_trial(std::int64_t row, std::int64_t moves);

/// Some trial with `moves` torque levels: random, a function of the row alone. In some the motion is lost in
/// a level; nothing is then measured of those after it.
TrialRecord random_open_loop_trial(std::int64_t row, std::int64_t moves);

/// Writes the results file of `study` with these trials, [row], by way of one shard in the folder of `path`.
void write_study_file(const std::filesystem::path& path, const study::Study& study,
                      const std::vector<TrialRecord>& trials,
                      const std::vector<layout::PointColumn>& statistics = {});
void write_study_file(const std::filesystem::path& path, const study::Study& study,
                      const std::vector<TrialRecord>& trials, const testing::StatisticsOfPoints& statistics,
                      const layout::MeasureTable& measures = layout::measure_table());

}  // namespace zerocount::testing
