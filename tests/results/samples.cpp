#include "tests/results/samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <span>

#include "core/hash/sha256.hpp"
#include "experiments/study/plan.hpp"
#include "results/layout/header.hpp"
#include "tests/support/merged_file.hpp"

namespace zerocount::testing {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

study::SweepAxis sample_number_axis(std::int64_t points) {
  study::SweepAxis axis{
      "controller.ki", "N m/count", "integral gain", study::SweepAxis::Kind::number, {}, {}};
  for (std::int64_t point = 0; point < points; ++point)
    axis.numbers.push_back(point == 0 ? nan : 3.85e-5 * static_cast<double>(point));
  return axis;
}

study::SweepAxis sample_case_axis(std::int64_t points) {
  study::SweepAxis axis{"case", "", "named case of the sweep", study::SweepAxis::Kind::text, {}, {}};
  for (std::int64_t point = 0; point < points; ++point)
    axis.texts.push_back("Fall \u00e4, \"" + std::to_string(point) + "\"");
  return axis;
}

trial::MoveOutcome sample_move(std::mt19937_64& random, std::int64_t move, std::vector<trial::Jerk>& jerks) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> small(0, 9);
  trial::MoveOutcome outcome;
  outcome.outcome = static_cast<trial::Outcome>(small(random) % 6);
  outcome.arrived = small(random) < 8;
  if (outcome.arrived) {
    outcome.arrival = small(random) * 10;
    outcome.arrival_time = static_cast<double>(outcome.arrival) / 2000.0;
    outcome.stable = small(random) < 7;
  }
  outcome.broke_away = small(random) < 2;
  outcome.saturated = small(random) < 1;
  outcome.overshoot = small(random);
  outcome.holding_torque = 0.01 * normal(random);
  outcome.peak_torque = std::abs(outcome.holding_torque) + 0.01;
  outcome.creep = 1e-7 * normal(random);
  outcome.final_position = 1e-4 * normal(random);
  outcome.final_error = 5 - small(random);
  outcome.midway_error = 2 * outcome.final_error;
  if (outcome.final_error == 0) outcome.final_settling_time = 0.001 * small(random);
  if (outcome.arrived) outcome.zero_fraction = 0.1 * small(random);
  if (outcome.outcome == trial::Outcome::oscillating) {
    outcome.oscillation_amplitude = 0.5 * small(random);
    outcome.oscillation_period = small(random) < 2 ? nan : 0.01 * small(random);
  }
  outcome.true_error = outcome.outcome == trial::Outcome::open_loop ? nan : 3.0 * normal(random);
  outcome.travel_time = 0.01 * small(random);
  outcome.phase_changes = small(random) / 3;
  outcome.encoder_disagreement = 7 * small(random);
  outcome.reversal_depth = small(random);
  outcome.jerk_count = outcome.arrived && small(random) < 6 ? small(random) / 2 : 0;
  for (std::int64_t count = 0; count < outcome.jerk_count; ++count) {
    const double onset = 0.1 * static_cast<double>(count) + 0.01;
    jerks.push_back(
        {move, onset, 0.0005 * (1 + small(random)), 1 + small(random) / 8, small(random) < 5 ? -1 : 1});
    outcome.jerk_agreement = 0.5;
  }
  outcome.stopped = small(random) < 3;
  if (small(random) > 2) {
    outcome.rest_error_rms = 0.1 * small(random);
    outcome.rest_error_range = 0.3 * small(random);
    outcome.rest_torque_power = 1e-4 * small(random);
    outcome.rest_torque_noise = 1e-9 * small(random);
    outcome.following_error_rms = outcome.following_error_peak = 2.0 * small(random);
    outcome.step_motion = normal(random);
    outcome.step_made = small(random) < 5;
  }
  return outcome;
}

trial::SampleRecord sample_record(std::int64_t k) {
  const auto time = static_cast<double>(k);
  return {k,           time / 2000.0,
          10,          k / 3,
          k / 60,      10 - k / 3,
          k % 5,       2.4e-4 * static_cast<double>(k % 5),
          1e-6 * time, 1e-3,
          1e-9 * time, 2e-9 * time,
          k % 4,       k % 7 == 6 ? trial::HookMode::slide : trial::HookMode::stick,
          k / 2,       k % 3 == 0 ? loop::ControlPhase::coarse : loop::ControlPhase::fine,
          1e-5 * time};
}

}  // namespace

study::Study sample_study(std::int64_t points, std::int64_t trials, std::int64_t moves) {
  study::Study study;
  study.name = "sample";
  study.seed = 0xfedcba9876543210ULL;
  study.trials = trials;
  study.moves = moves;
  study.manifest.text =
      "zerocount: 1\n# \u03bb, a comment\nname: sample\ntrials: " + std::to_string(trials) + "\n";
  study.manifest.sha256 = hash::sha256_hex(study.manifest.text);
  study.manifest.overrides = {"trials=" + std::to_string(trials), "name=sample"};
  study.study_sha256 =
      hash::sha256_hex(study.manifest.text + std::to_string(points) + "," + std::to_string(moves));
  for (std::int64_t point = 0; point < points; ++point)
    study.points.labels.push_back("point " + std::to_string(point));
  study.points.axes = {sample_number_axis(points), sample_case_axis(points)};
  study.columns.inputs = {{"friction.k1", "N m/rad", "lowest stiffness"},
                          {"command.targets.0", "count", "target"}};
  auto profile = std::make_shared<friction::Profile>();
  profile->location = std::log(110.0);
  profile->scale = 0.1;
  profile->cosine = {0.0, 0.5};
  profile->sine = {0.0, 0.25};
  study.profiles = {{"friction.k1", "N m/rad", profile}};
  study.retained_trials = {0};
  study.features.travel = study.features.phases = study.features.drive_torque = true;
  study.features.stopping = study.features.motion = study.features.steps = true;
  study.features.following = study.features.reversals = true;
  return study;
}

study::Study sample_study_with_machines(std::int64_t points, std::int64_t trials, std::int64_t moves) {
  study::Study study = sample_study(points, trials, moves);
  study.machines = 8;
  auto plan = std::make_shared<study::StudyPlan>();
  plan->base = {{.kind = study::Value::Kind::distribution, .index = 0, .level = study::DrawLevel::machine}};
  plan->distributions = {distributions::Uniform{100.0, 120.0}};
  plan->randomness.resize(1);
  plan->shared_inputs[study::Grouping::machine] = {{0, false}};
  study.plan = std::move(plan);
  study.columns.shared[study::Grouping::machine] = {
      {"friction.k1", "N m/rad", "lowest stiffness", study::DrawLevel::machine}};
  study::RealisedProfile of_machines{"friction.k2", "N m/rad", study.profiles[0].profile};
  of_machines.of_machine = [one = study.profiles[0].profile](std::int64_t machine) {
    friction::Profile rotor = *one;
    rotor.location += 0.01 * static_cast<double>(machine);
    return std::make_shared<const friction::Profile>(rotor);
  };
  study.profiles.push_back(of_machines);
  return study;
}

shards::TrialResult sample_result(const study::Study& study, std::int64_t row) {
  std::mt19937_64 random(static_cast<std::uint64_t>(row) + 1);
  std::normal_distribution<double> normal;
  shards::TrialResult result;
  result.row = row;
  for (std::size_t input = 0; input < study.columns.inputs.size(); ++input)
    result.inputs.push_back(normal(random));
  for (std::int64_t move = 0; move < study.moves; ++move)
    result.outcome.moves.push_back(sample_move(random, move, result.jerks));
  const std::int64_t index = row % study.trials;
  for (const std::int64_t retained : study.retained_trials) {
    for (std::int64_t k = 0; retained == index && k < 50; ++k) result.trace.push_back(sample_record(k));
  }
  return result;
}

std::vector<shards::TrialResult> sample_results(const study::Study& study, layout::RowRange rows) {
  std::vector<shards::TrialResult> results;
  for (std::int64_t row = rows.first; row < rows.end(); ++row) results.push_back(sample_result(study, row));
  return results;
}

std::vector<double> inputs_of(const reading::AllTrialsFile& file, std::int64_t row) {
  std::vector<double> values;
  for (std::size_t column = 0; column < file.input_columns().size(); ++column)
    values.push_back(file.input(column, {row, 1}).front());
  return values;
}

layout::Provenance sample_provenance() {
  layout::Provenance provenance = layout::current_provenance();
  provenance.created = "2002-07-21T12:00:00Z";
  return provenance;
}

shards::ShardInfo write_sample_shard(const std::filesystem::path& directory, const study::Study& study,
                                     layout::RowRange rows) {
  const std::filesystem::path path = shards::shard_path(directory, rows);
  shards::write_shard(path, study, rows, sample_results(study, rows), {}, {sample_provenance()});
  return {path, rows};
}

std::vector<shards::ShardInfo> write_sample_shards(const std::filesystem::path& directory,
                                                   const study::Study& study, layout::RowRange rows,
                                                   std::int64_t size) {
  std::filesystem::create_directories(directory);
  std::vector<shards::ShardInfo> shards;
  for (std::int64_t first = rows.first; first < rows.end(); first += size)
    shards.push_back(write_sample_shard(directory, study, {first, std::min(size, rows.end() - first)}));
  return shards;
}

layout::StoredStatistics sample_statistics(const reading::AllTrialsFile& file) {
  const std::int64_t trials = file.header().trials;
  layout::PointColumn count{"trials", "1", "trials of the design point", {}};
  layout::PointColumn settling{"arrival_time_mean", "s", "mean settling time of the first move", {}};
  for (std::int64_t point = 0; point < file.header().points; ++point) {
    const std::vector<double> times = file.measure("arrival_time", {point * trials, trials});
    double sum = 0.0;
    double arrived = 0.0;
    for (std::size_t i = 0; i < times.size(); i += static_cast<std::size_t>(file.moves())) {
      if (std::isnan(times[i])) continue;
      sum += times[i];
      arrived += 1.0;
    }
    count.values.push_back(static_cast<double>(trials));
    settling.values.push_back(sum / arrived);
  }
  layout::StoredStatistics stored{{count, settling}, {sample_table(file)}, {}};
  if (const std::optional<reading::StoredGroups> machines = file.groups("machine")) {
    stored.groups["machine"] =
        counted_worlds(file, machines->count);  // as if trial i were on machine i mod 8
    stored.groups["machine"].goal_met.clear();
  }
  return stored;
}

/// Table of a statistic: the largest holding torque of every move at every design point.
layout::StatisticTable sample_table(const reading::AllTrialsFile& file) {
  const std::int64_t trials = file.header().trials;
  const auto moves = static_cast<std::size_t>(file.moves());
  layout::PointColumn largest{"torque_max", "N m", "largest holding torque", {}};
  for (std::int64_t point = 0; point < file.header().points; ++point) {
    const std::vector<double> torques = file.measure("holding_torque", {point * trials, trials});
    for (std::size_t move = 0; move < moves; ++move) {
      double value = torques[move];
      for (std::size_t i = move; i < torques.size(); i += moves) value = std::max(value, torques[i]);
      largest.values.push_back(value);
    }
  }
  return {&layout::level_group(), file.moves(), {largest}};
}

std::filesystem::path write_sample_file(const std::filesystem::path& directory, const study::Study& study,
                                        std::int64_t size) {
  const std::filesystem::path path = directory / "sample.h5";
  const std::vector<shards::ShardInfo> shards =
      write_sample_shards(layout::shards_directory(path), study, layout::all_rows(study), size);
  testing::merge_shards(shards, study, path, layout::all_rows(study), sample_statistics,
                        {sample_provenance()});
  return path;
}

/// A made-up study with seven worlds (possible sets of the values that all machines share). Of the 40 trials
/// at a design point, five worlds have six each and two have five each.
study::Study sample_study_in_worlds() {
  study::Study study = sample_study(3, 40, 2);
  study.worlds = 7;
  auto plan = std::make_shared<study::StudyPlan>();
  plan->base = {{.kind = study::Value::Kind::distribution, .index = 0, .level = study::DrawLevel::world}};
  plan->distributions = {distributions::Uniform{100.0, 120.0}};
  plan->randomness.resize(1);
  plan->shared_inputs[study::Grouping::world] = {{0, false}};
  study.plan = std::move(plan);
  study.columns.shared[study::Grouping::world] = {
      {"friction.k1", "N m/rad", "lowest stiffness", study::DrawLevel::world}};
  return study;
}

/// Counts of the trials in the file. A trial is taken to meet the goal if its first move arrived.
layout::GroupCounts counted_worlds(const reading::AllTrialsFile& file, std::int64_t worlds) {
  const std::vector<std::vector<std::int64_t>> none(
      static_cast<std::size_t>(file.header().points),
      std::vector<std::int64_t>(static_cast<std::size_t>(worlds), 0));
  layout::GroupCounts counts{none, none, none};
  const std::vector<trial::MoveOutcome> outcomes = file.outcomes(file.rows());
  for (std::int64_t row = 0; row < file.rows().count; ++row) {
    const auto point = static_cast<std::size_t>(row / file.header().trials);
    const auto world = static_cast<std::size_t>(row % file.header().trials % worlds);
    const std::span moves(outcomes.begin() + row * file.moves(), static_cast<std::size_t>(file.moves()));
    ++counts.trials[point][world];
    counts.success[point][world] += trial::succeeded(moves) ? 1 : 0;
    counts.goal_met[point][world] += moves.front().arrived ? 1 : 0;
  }
  return counts;
}

std::filesystem::path write_file_in_worlds(const std::filesystem::path& directory, const study::Study& study,
                                           bool has_goal, std::int64_t size) {
  const std::filesystem::path path = directory / "worlds.h5";
  const std::vector<shards::ShardInfo> shards =
      write_sample_shards(directory / "shards", study, layout::all_rows(study), size);
  const auto statistics = [&](const reading::AllTrialsFile& file) {
    layout::StoredStatistics stored = sample_statistics(file);
    const std::size_t points = static_cast<std::size_t>(file.header().points);
    const auto add = [&](const char* name, std::int64_t groups) {
      if (groups > 0) stored.groups[name] = counted_worlds(file, groups);
    };
    add("world", study.worlds);
    if (!has_goal) stored.groups["world"].goal_met.clear();
    add("condition", std::ssize(study.settings.conditions));
    add("age", std::ssize(study.settings.ages.at));
    if (!study.settings.ages.at.empty()) {
      const std::vector<double> of_ages(points * study.settings.ages.at.size(), 0.5);
      const std::vector<double> lives(points * static_cast<std::size_t>(study.machines));
      stored.groups["age"].statistics = {{"machines", "1", "proportion of machines", of_ages}};
      stored.groups["machine"].statistics = {{"life", study.settings.ages.unit, "last age", lives}};
    }
    return stored;
  };
  testing::merge_shards(shards, study, path, layout::all_rows(study), statistics, {sample_provenance()});
  return path;
}

}  // namespace zerocount::testing
