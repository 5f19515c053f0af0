#include "results/shards/study_tables.hpp"

#include "core/failure/failure.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/plan.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/reading/export.hpp"
#include "results/reading/first_difference.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/checksum.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

TEST(MachineTables, HaveTheParametersThatDifferBetweenMachines) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_machines();
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  const reading::StoredGroups stored = file.groups("machine").value();
  ASSERT_EQ(stored.columns.size(), 1U);
  EXPECT_EQ(stored.columns[0].name, "friction.k1");
  EXPECT_EQ(stored.columns[0].unit, "N m/rad");
  for (std::int64_t machine = 0; machine < 8; ++machine)
    EXPECT_EQ(stored.inputs[0][static_cast<std::size_t>(machine)],
              study::group_inputs(study, study::Grouping::machine, machine)[0]);
}

TEST(MachineTables, HaveTheRotorOfEveryMachine) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_machines();
  const std::vector<reading::StoredProfile> stored =
      reading::AllTrialsFile(write_sample_file(directory.path(), study)).profiles();
  ASSERT_EQ(stored.size(), 2U);
  EXPECT_EQ(stored[0].machines, 0);
  EXPECT_EQ(stored[1].machines, 8);
  ASSERT_EQ(stored[1].theta.size(), 64U);  // of two harmonics
  for (std::int64_t machine = 0; machine < 8; ++machine) {
    for (std::size_t i = 0; i < 64; ++i) {
      EXPECT_EQ(stored[1].value[static_cast<std::size_t>(machine) * 64 + i],
                friction::value_at(*study.profiles[1].of_machine(machine), stored[1].theta[i]));
    }
  }
}

TEST(MachineTables, AnglesResolveTheFieldWithinTheDiskLimit) {
  EXPECT_EQ(layout::profile_angles_of_machine(2, 10), 64);
  EXPECT_EQ(layout::profile_angles_of_machine(52, 10), 512);
  EXPECT_EQ(layout::profile_angles_of_machine(52, 1000), 512);
  EXPECT_EQ(layout::profile_angles_of_machine(52, 10'000), 256);
  EXPECT_EQ(layout::profile_angles_of_machine(52, 1'000'000), 128);
  EXPECT_EQ(layout::profile_angles_of_machine(10'000, 2), 4096);
}

TEST(MachineTables, DoNotDependOnHowTheRowsAreDividedAmongTheShards) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  const study::Study study = sample_study_with_machines();
  const reading::AllTrialsFile one(write_sample_file(first.path(), study, 7));
  const reading::AllTrialsFile other(write_sample_file(second.path(), study, 50));
  EXPECT_EQ(reading::first_difference(one.root(), other.root()), std::nullopt);
}

TEST(MachineTables, APartHasTheMachinesAndNoCounts) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_machines();
  const layout::RowRange rows{0, 60};
  const std::vector<shards::ShardInfo> shards =
      write_sample_shards(directory.path() / "shards", study, rows, 20);
  const std::filesystem::path path = directory.path() / "part.h5";
  testing::merge_shards(shards, study, path, rows, {}, {sample_provenance()});
  const reading::AllTrialsFile part(path, reading::Require::any_part);
  EXPECT_EQ(part.groups("machine").value().count, 8);
  EXPECT_TRUE(part.groups("machine").value().success.empty());
  EXPECT_EQ(
      reading::AllTrialsFile(shards[0].path, reading::Require::any_part, nullptr, &study).groups("machine"),
      std::nullopt);
}

TEST(MachineTables, AreAbsentWithoutMachines) {
  const TemporaryFolder directory;
  EXPECT_FALSE(reading::AllTrialsFile(write_sample_file(directory.path(), sample_study()))
                   .groups("machine")
                   .has_value());
}

TEST(MachineTables, AreExported) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_machines();
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  const std::filesystem::path out = directory.path() / "tables";
  reading::export_csv(file, out);
  const std::string machines = read_bytes(out / "machines.csv");
  EXPECT_TRUE(machines.starts_with("machine,friction.k1 [N m/rad]\n0,")) << machines;
  EXPECT_EQ(std::count(machines.begin(), machines.end(), '\n'), 9);
  const std::string counts = read_bytes(out / "machine_counts.csv");
  EXPECT_TRUE(counts.starts_with("point,machine,success,trials\n0,0,")) << counts;
  EXPECT_EQ(std::count(counts.begin(), counts.end(), '\n'), 1 + 3 * 8);
  const std::string profiles = read_bytes(out / "profiles.csv");
  EXPECT_TRUE(profiles.starts_with("profile,machine,theta [rad],value,unit of value\nfriction.k1,,0,"))
      << profiles.substr(0, 100);
  EXPECT_EQ(std::count(profiles.begin(), profiles.end(), '\n'), 1 + 4096 + 8 * 64);
}

// What a results file says of the worlds of its study: their inputs, and the counts of their trials.

std::vector<std::int64_t> flattened(const std::vector<std::vector<std::int64_t>>& rows) {
  std::vector<std::int64_t> values;
  for (const std::vector<std::int64_t>& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

TEST(WorldTables, HaveTheParametersThatDifferBetweenWorlds) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_in_worlds();
  const reading::AllTrialsFile file(write_file_in_worlds(directory.path(), study));
  const reading::StoredGroups stored = file.groups("world").value();
  EXPECT_EQ(stored.count, 7);
  ASSERT_EQ(stored.columns.size(), 1U);
  EXPECT_EQ(stored.columns[0].name, "friction.k1");
  EXPECT_EQ(stored.columns[0].unit, "N m/rad");
  for (std::int64_t world = 0; world < 7; ++world)
    EXPECT_EQ(stored.inputs[0][static_cast<std::size_t>(world)],
              study::group_inputs(study, study::Grouping::world, world)[0]);
}

TEST(WorldTables, HaveTheTrialsOfEveryWorldAtEveryPoint) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_in_worlds();
  const reading::AllTrialsFile file(write_file_in_worlds(directory.path(), study));
  const layout::GroupCounts counts = counted_worlds(file, 7);
  EXPECT_EQ(counts.trials[1], (std::vector<std::int64_t>{6, 6, 6, 6, 6, 5, 5}));
  const reading::StoredGroups stored = file.groups("world").value();
  EXPECT_EQ(stored.trials, flattened(counts.trials));
  EXPECT_EQ(stored.success, flattened(counts.success));
  EXPECT_EQ(stored.goal_met, flattened(counts.goal_met));
}

TEST(WorldTables, HaveNoGoalIfTheStudyHasNone) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_in_worlds();
  const reading::AllTrialsFile file(write_file_in_worlds(directory.path(), study, false));
  const reading::StoredGroups stored = file.groups("world").value();
  EXPECT_EQ(stored.success, flattened(counted_worlds(file, 7).success));
  EXPECT_TRUE(stored.goal_met.empty());
}

TEST(WorldTables, DoNotDependOnHowTheRowsAreDividedAmongTheShards) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  const study::Study study = sample_study_in_worlds();
  const reading::AllTrialsFile one(write_file_in_worlds(first.path(), study, true, 7));
  const reading::AllTrialsFile other(write_file_in_worlds(second.path(), study, true, 50));
  EXPECT_EQ(reading::first_difference(one.root(), other.root()), std::nullopt);
}

TEST(WorldTables, APartHasNoCounts) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_in_worlds();
  const layout::RowRange rows{0, 60};
  const std::vector<shards::ShardInfo> shards =
      write_sample_shards(directory.path() / "shards", study, rows, 20);
  const std::filesystem::path path = directory.path() / "part.h5";
  testing::merge_shards(shards, study, path, rows, {}, {sample_provenance()});
  const reading::StoredGroups stored =
      reading::AllTrialsFile(path, reading::Require::any_part).groups("world").value();
  EXPECT_EQ(stored.count, 7);
  EXPECT_EQ(stored.inputs[0].size(), 7U);
  EXPECT_TRUE(stored.success.empty());
  EXPECT_FALSE(reading::AllTrialsFile(shards[0].path, reading::Require::any_part, nullptr, &study)
                   .groups("world")
                   .has_value());
}

TEST(WorldTables, AreAbsentWithoutWorlds) {
  const TemporaryFolder directory;
  EXPECT_FALSE(reading::AllTrialsFile(write_sample_file(directory.path(), sample_study()))
                   .groups("world")
                   .has_value());
}

TEST(WorldTables, AreExported) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_in_worlds();
  const std::filesystem::path out = directory.path() / "tables";
  reading::export_csv(reading::AllTrialsFile(write_file_in_worlds(directory.path(), study)), out);
  const std::string worlds = read_bytes(out / "worlds.csv");
  EXPECT_TRUE(worlds.starts_with("world,friction.k1 [N m/rad]\n0,")) << worlds;
  EXPECT_EQ(std::count(worlds.begin(), worlds.end(), '\n'), 1 + 7);
  const std::string counts = read_bytes(out / "world_counts.csv");
  EXPECT_TRUE(counts.starts_with("point,world,success,trials,goal_met\n0,0,")) << counts;
  EXPECT_EQ(std::count(counts.begin(), counts.end(), '\n'), 1 + 3 * 7);
}

/// A copy of the results file with another count for one world at one design point, and a new checksum
/// trailer.
std::filesystem::path with_world_count(const std::filesystem::path& original, const std::string& dataset,
                                       std::int64_t point, std::size_t world, std::int64_t count) {
  const std::filesystem::path path = original.parent_path() / "forged.h5";
  std::filesystem::copy_file(original, path, std::filesystem::copy_options::overwrite_existing);
  remove_checksum(path);
  hdf5::File file = hdf5::File::open_to_change(path);
  {
    hdf5::Dataset counts = file.open_dataset(dataset);
    std::vector<std::int64_t> row(7);
    counts.read(point, 1, row.data());
    row[world] = count;
    counts.write(point, 1, row.data());
  }
  file.close();
  append_checksum(path);
  return path;
}

// World 4 has six trials at each point, and world 5 has five.
TEST(WorldTables, ImpossibleCountsAreRefused) {
  const TemporaryFolder directory;
  const std::filesystem::path original = write_file_in_worlds(directory.path(), sample_study_in_worlds());
  const auto expect_refused = [&](const std::string& dataset, std::size_t world, std::int64_t count) {
    const reading::AllTrialsFile file(with_world_count(original, dataset, 1, world, count));
    const std::string words = "row 1: impossible counts of world " + std::to_string(world) +
                              "; expected 0 to " + (world < 5 ? "6" : "5") + " trials";
    expect_failure(ExitCode::bad_data, words, [&] { file.groups("world"); });
  };
  for (const std::string dataset : {"world/trials", "world/success", "world/goal_met"}) {
    SCOPED_TRACE(dataset);
    for (const std::size_t world : {std::size_t{4}, std::size_t{5}}) {
      expect_refused(dataset, world, -1);
      expect_refused(dataset, world, world == 4 ? 7 : 6);
    }
  }
  EXPECT_NO_THROW(
      reading::AllTrialsFile(with_world_count(original, "world/success", 1, 4, 0)).groups("world"));
}

}  // namespace
}  // namespace zerocount::testing
