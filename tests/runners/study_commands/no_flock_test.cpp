// Runs on a file system without flock, such as some network file systems.
#include <cerrno>
#include <csignal>

#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class WithoutFlock : public ::testing::Test {
 protected:
  ProgramResult program(const std::vector<std::string>& arguments) const {
    return zerocount_program(arguments, folder_.path(),
                             {std::string("LD_PRELOAD=") + ZEROCOUNT_NO_FLOCK,
                              "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0"});
  }

  std::vector<std::string> owner_files() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      if (name.find(".owner-") != std::string::npos) names.push_back(name);
    }
    return names;
  }

  TemporaryFolder folder_;
};

TEST_F(WithoutFlock, ARunGivesTheSameDataAndSaysHowItIsLocked) {
  folder_.write("study.yaml", small_manifest(8));
  const ProgramResult result = program({"run", "study.yaml", "-o", "out.h5"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(result.err, "out.h5: the file system has no locks (flock); out.h5.owner-"));
  EXPECT_EQ(owner_files().size(), 0U);
  ASSERT_EQ(zerocount_program({"run", "study.yaml", "-o", "locked.h5"}, folder_.path()).code, 0);
  EXPECT_EQ(stored_datasets(folder_ / "out.h5"), stored_datasets(folder_ / "locked.h5"));
}

TEST_F(WithoutFlock, PartsAreMerged) {
  folder_.write("study.yaml", small_manifest(8));
  for (const std::string part : {"1", "2"})
    ASSERT_EQ(program({"run", "study.yaml", "-o", part + ".h5", "--shard", part + "/2"}).code, 0);
  const ProgramResult merged = program({"merge", "1.h5", "2.h5", "-o", "all.h5"});
  EXPECT_EQ(merged.code, 0) << merged.err;
  EXPECT_EQ(owner_files().size(), 0U);
}

TEST_F(WithoutFlock, TheOwnerFileOfAKilledRunStopsNothing) {
  folder_.write("study.yaml", small_manifest(100000));
  const std::string line = "cd " + folder_.path().string() +
                           " && LD_PRELOAD=" ZEROCOUNT_NO_FLOCK
                           " ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0 " ZEROCOUNT_PROGRAM
                           " run study.yaml -q -o out.h5 & sleep 0.5; kill -KILL $!; wait $!";
  ASSERT_NE(std::system(line.c_str()), 0);
  ASSERT_EQ(owner_files().size(), 1U);
  folder_.write("study.yaml", small_manifest(8));
  const ProgramResult result = program({"run", "study.yaml", "-q", "-o", "out.h5", "--force"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(owner_files().size(), 0U);
}

// Runs on a file system that cannot bring the entries of a folder to the disk, as some network and user-space
// file systems.

ProgramResult run_where_folders_fail_with(int error, const TemporaryFolder& folder) {
  return zerocount_program(
      {"run", "study.yaml", "-o", std::to_string(error) + ".h5"}, folder.path(),
      {std::string("LD_PRELOAD=") + ZEROCOUNT_NO_FOLDER_FSYNC, "FSYNC_ERROR=" + std::to_string(error),
       "ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0"});
}

TEST(WithoutFsyncOfFolders, ARunIsCompleteAndADiskThatFailsIsNotForgiven) {
  const TemporaryFolder folder;
  folder.write("study.yaml", small_manifest(8));
  for (const int missing : {EINVAL, EOPNOTSUPP, ENOSYS}) {
    const ProgramResult result = run_where_folders_fail_with(missing, folder);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(zerocount_program({"summary", std::to_string(missing) + ".h5"}, folder.path()).code, 0);
  }
  const ProgramResult broken = run_where_folders_fail_with(EIO, folder);
  EXPECT_EQ(broken.code, 5);
  EXPECT_TRUE(says(broken.err, "cannot bring its name to the disk"));
}

}  // namespace
}  // namespace zerocount::testing
