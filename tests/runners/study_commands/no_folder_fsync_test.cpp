// Runs on a file system that cannot bring the entries of a folder to the disk, as some network and user-space
// file systems.
#include <cerrno>
#include <string>

#include <gtest/gtest.h>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

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
  EXPECT_NE(broken.err.find("cannot bring its name to the disk"), std::string::npos) << broken.err;
}

}  // namespace
}  // namespace zerocount::testing
