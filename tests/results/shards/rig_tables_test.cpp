#include "results/shards/rig_tables.hpp"

#include "core/failure/failure.hpp"
#include "results/reading/export.hpp"
#include "results/reading/first_difference.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

TEST(RigTables, HaveWhatDiffersBetweenTheRigs) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_rigs();
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  const reading::StoredGroups stored = file.rigs().value();
  ASSERT_EQ(stored.columns.size(), 1U);
  EXPECT_EQ(stored.columns[0].name, "friction.k1");
  EXPECT_EQ(stored.columns[0].unit, "N m/rad");
  for (std::int64_t rig = 0; rig < 8; ++rig) {
    EXPECT_EQ(stored.inputs[0][static_cast<std::size_t>(rig)], study::rig_inputs(study, rig)[0]);
  }
}

TEST(RigTables, HaveTheRotorOfEveryRig) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_rigs();
  const std::vector<reading::StoredProfile> stored =
      reading::AllTrialsFile(write_sample_file(directory.path(), study)).profiles();
  ASSERT_EQ(stored.size(), 2U);
  EXPECT_EQ(stored[0].rigs, 0);
  EXPECT_EQ(stored[1].rigs, 8);
  ASSERT_EQ(stored[1].theta.size(), 64U);  // of two harmonics
  for (std::int64_t rig = 0; rig < 8; ++rig) {
    for (std::size_t i = 0; i < 64; ++i) {
      EXPECT_EQ(stored[1].value[static_cast<std::size_t>(rig) * 64 + i],
                friction::value_at(*study.profiles[1].of_rig(rig), stored[1].theta[i]));
    }
  }
}

TEST(RigTables, AnglesAreEnoughForTheFieldAndNotTooManyForTheDisk) {
  EXPECT_EQ(layout::profile_angles_of_rig(2, 10), 64);
  EXPECT_EQ(layout::profile_angles_of_rig(52, 10), 512);
  EXPECT_EQ(layout::profile_angles_of_rig(52, 1000), 512);
  EXPECT_EQ(layout::profile_angles_of_rig(52, 10'000), 256);
  EXPECT_EQ(layout::profile_angles_of_rig(52, 1'000'000), 128);
  EXPECT_EQ(layout::profile_angles_of_rig(10'000, 2), 4096);
}

TEST(RigTables, DoNotDependOnHowTheRowsAreDividedAmongTheShards) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  const study::Study study = sample_study_with_rigs();
  const reading::AllTrialsFile one(write_sample_file(first.path(), study, 7));
  const reading::AllTrialsFile other(write_sample_file(second.path(), study, 50));
  EXPECT_EQ(reading::first_difference(one.root(), other.root()), std::nullopt);
}

TEST(RigTables, APartHasTheRigsAndNoCounts) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_rigs();
  const layout::RowRange rows{0, 60};
  const std::vector<shards::ShardInfo> shards =
      write_sample_shards(directory.path() / "shards", study, rows, 20);
  const std::filesystem::path path = directory.path() / "part.h5";
  testing::merge_shards(shards, study, path, rows, {}, {sample_provenance()});
  const reading::AllTrialsFile part(path, reading::Require::any_part);
  EXPECT_EQ(part.rigs().value().count, 8);
  EXPECT_TRUE(part.rigs().value().success.empty());
  EXPECT_EQ(reading::AllTrialsFile(shards[0].path, reading::Require::any_part).rigs(), std::nullopt);
}

TEST(RigTables, AreNoneWithoutRigs) {
  const TemporaryFolder directory;
  EXPECT_FALSE(
      reading::AllTrialsFile(write_sample_file(directory.path(), sample_study())).rigs().has_value());
}

TEST(RigTables, AreExported) {
  const TemporaryFolder directory;
  const study::Study study = sample_study_with_rigs();
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  const std::filesystem::path out = directory.path() / "tables";
  reading::export_csv(file, out);
  const std::string rigs = read_bytes(out / "rigs.csv");
  EXPECT_TRUE(rigs.starts_with("rig,friction.k1 [N m/rad]\n0,")) << rigs;
  EXPECT_EQ(std::count(rigs.begin(), rigs.end(), '\n'), 9);
  const std::string counts = read_bytes(out / "rig_counts.csv");
  EXPECT_TRUE(counts.starts_with("point,rig,success,trials\n0,0,")) << counts;
  EXPECT_EQ(std::count(counts.begin(), counts.end(), '\n'), 1 + 3 * 8);
  const std::string profiles = read_bytes(out / "profiles.csv");
  EXPECT_TRUE(profiles.starts_with("profile,rig,theta [rad],value,unit of value\nfriction.k1,,0,"))
      << profiles.substr(0, 100);
  EXPECT_EQ(std::count(profiles.begin(), profiles.end(), '\n'), 1 + 4096 + 8 * 64);
}

}  // namespace
}  // namespace zerocount::testing
