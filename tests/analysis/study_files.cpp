#include "tests/analysis/study_files.hpp"

#include <cmath>
#include <random>
#include <string>

#include "core/hash/sha256.hpp"
#include "results/shards/shard.hpp"
#include "tests/support/merged_file.hpp"

namespace zerocount::testing {

study::Study plain_study(std::int64_t points, std::int64_t trials, std::int64_t moves) {
  study::Study study;
  study.name = "plain";
  study.seed = 1;
  study.trials = trials;
  study.moves = moves;
  study.manifest.text = "zerocount: 1\n";
  study.manifest.sha256 = hash::sha256_hex(study.manifest.text);
  study.study_sha256 = study.manifest.sha256;
  study::SweepAxis axis{
      "controller.ki", "N m/count", "integral gain", study::SweepAxis::Kind::number, {}, {}};
  for (std::int64_t point = 0; point < points; ++point) {
    study.points.labels.push_back("point " + std::to_string(point));
    axis.numbers.push_back(1e-5 * static_cast<double>(point + 1));
  }
  study.points.axes = {axis};
  return study;
}

TrialRecord random_trial(std::int64_t row, std::int64_t moves) {
  std::mt19937_64 random(static_cast<std::uint64_t>(row) + 1);
  std::normal_distribution<double> normal;
  TrialRecord trial;
  for (std::int64_t index = 0; index < moves; ++index) {
    trial::MoveOutcome move;
    move.outcome = static_cast<trial::Outcome>(random() % 4);
    move.arrived = random() % 4 != 0;
    if (move.arrived) {
      move.arrival = static_cast<std::int64_t>(random() % 300);
      move.arrival_time = static_cast<double>(move.arrival) / 2000.0;
      move.stable = random() % 3 != 0;
      move.jerk_count = static_cast<std::int64_t>(random() % 30);
    }
    move.broke_away = random() % 5 == 0;
    move.saturated = random() % 9 == 0;
    move.overshoot = static_cast<std::int64_t>(random() % 5);
    move.holding_torque = 0.01 * normal(random);
    move.peak_torque = 0.05;
    move.creep = 1e-7 * normal(random);
    move.reversal_depth = static_cast<std::int64_t>(random() % 12);
    move.final_error = static_cast<std::int64_t>(std::lround(3.0 * std::exp(2.0 * normal(random)))) - 3;
    if (move.outcome != trial::Outcome::nonfinite)
      move.true_error = static_cast<double>(move.final_error) + normal(random);
    move.travel_time = 0.01 * static_cast<double>(random() % 7);
    move.phase_changes = static_cast<std::int64_t>(random() % 3);
    move.encoder_disagreement = random() % 3 == 0 ? static_cast<std::int64_t>(random() % 100) : 0;
    std::int64_t sample = move.arrival + 100;
    for (std::int64_t count = 0; count < move.jerk_count; ++count) {
      sample += 1 + static_cast<std::int64_t>(random() % 200);
      const auto magnitude = static_cast<std::int64_t>(1 + random() % 2);
      trial.jerks.push_back(
          {index, static_cast<double>(sample) / 2000.0, 0.0005, magnitude, random() % 2 == 0 ? 1 : -1});
    }
    trial.outcome.moves.push_back(move);
  }
  return trial;
}

TrialRecord random_open_loop_trial(std::int64_t row, std::int64_t moves) {
  std::mt19937_64 random(static_cast<std::uint64_t>(row) + 1);
  std::normal_distribution<double> normal;
  TrialRecord trial;
  bool lost = false;
  for (std::int64_t index = 0; index < moves; ++index) {
    trial::MoveOutcome move;
    if (!lost) {
      lost = random() % 40 == 0;
      move.outcome = lost ? trial::Outcome::nonfinite : trial::Outcome::open_loop;
      move.holding_torque = 0.01 * static_cast<double>(index % 4) + 1e-6 * normal(random);
      move.peak_torque = 0.03;
      move.travel_time = 0.1;
      move.final_position = 1e-4 * static_cast<double>(index % 4) + 1e-8 * normal(random);
      move.final_error = static_cast<std::int64_t>(random() % 60) - 30;
      move.creep = 1e-7 * std::exp(normal(random));
      move.broke_away = random() % 5 == 0;
      move.reversal_depth = static_cast<std::int64_t>(random() % 12);
    }
    trial.outcome.moves.push_back(move);
  }
  return trial;
}

void write_study_file(const std::filesystem::path& path, const study::Study& study,
                      const std::vector<TrialRecord>& trials,
                      const std::vector<layout::PointColumn>& statistics) {
  write_study_file(path, study, trials, [&](const reading::AllTrialsFile&) {
    return layout::StoredStatistics{statistics, {}, {}};
  });
}

void write_study_file(const std::filesystem::path& path, const study::Study& study,
                      const std::vector<TrialRecord>& trials, const testing::StatisticsOfPoints& statistics,
                      const layout::MeasureTable& measures) {
  std::vector<shards::TrialResult> results(trials.size());
  for (std::size_t row = 0; row < trials.size(); ++row) {
    results[row].row = static_cast<std::int64_t>(row);
    results[row].inputs.assign(study.columns.inputs.size(), 0.0);
    results[row].outcome = trials[row].outcome;
    results[row].jerks = trials[row].jerks;
  }
  const layout::RowRange rows{0, static_cast<std::int64_t>(trials.size())};
  const std::filesystem::path shard = path.string() + ".shard.h5";
  shards::write_shard(shard, study, rows, results, {}, {.measures = &measures});
  const std::vector<shards::ShardInfo> shards{{shard, rows}};
  testing::merge_shards(shards, study, path, rows, statistics, {.measures = &measures});
}

}  // namespace zerocount::testing
