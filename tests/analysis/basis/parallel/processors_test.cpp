// The processors of a container are those of its quota.
#include "analysis/basis/parallel/processors.hpp"

#include <oneapi/tbb/info.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::parallel {
namespace {

class ProcessorQuota : public ::testing::Test {
 protected:
  void group(const std::string& path, const std::string& file, const std::string& text) const {
    std::filesystem::create_directories(folder_ / path);
    folder_.write(path + "/" + file, text);
  }
  void old_group(const std::string& path, const std::string& quota, const std::string& period) const {
    group(path, "cpu.cfs_quota_us", quota + "\n");
    group(path, "cpu.cfs_period_us", period + "\n");
  }
  std::optional<double> quota(const std::string& list) const {
    return processor_quota(folder_.write("list", list), folder_ / "mount");
  }

  testing::TemporaryFolder folder_;
};

TEST_F(ProcessorQuota, CgroupVersion2UsesTheLowestOfItsGroups) {
  group("mount/a/b", "cpu.max", "150000 100000\n");
  EXPECT_EQ(quota("0::/a/b\n"), 1.5);
  group("mount/a", "cpu.max", "max 100000\n");
  EXPECT_EQ(quota("0::/a/b\n"), 1.5);
  group("mount/a", "cpu.max", "50000 100000\n");
  EXPECT_EQ(quota("0::/a/b\n"), 0.5);
  EXPECT_EQ(quota("0::/other\n"), std::nullopt);
}

TEST_F(ProcessorQuota, AContainerReadsItsRootGroup) {
  group("mount", "cpu.max", "400000 100000\n");
  for (const char* const list : {"0::/\n", "0::/docker/0123456789ab\n", "0::/../..\n"})
    EXPECT_EQ(quota(list), 4.0) << list;
}

TEST_F(ProcessorQuota, CgroupVersion1UsesTheCpuController) {
  const std::string list = "12:memory:/m\n5:cpu,cpuacct:/docker/x\n3:cpuset:/\n1:name=systemd:/\n";
  old_group("mount/memory/m", "1000", "100000");
  old_group("mount/cpu/docker/x", "300000", "100000");
  EXPECT_EQ(quota(list), 3.0);
  old_group("mount/cpu,cpuacct", "-1", "100000");
  EXPECT_EQ(quota(list), std::nullopt);  // its own folder, not that of the link
  old_group("mount/cpu,cpuacct/docker/x", "25000", "50000");
  EXPECT_EQ(quota(list), 0.5);
  // Both versions at once: systemd's hybrid mode.
  EXPECT_EQ(quota(list + "0::/\n"), 0.5);
}

TEST_F(ProcessorQuota, IsAbsentIfNoGroupSetsOne) {
  EXPECT_EQ(quota(""), std::nullopt);
  EXPECT_EQ(quota("not of this form\n"), std::nullopt);
  EXPECT_EQ(processor_quota(folder_ / "no file", folder_ / "mount"), std::nullopt);
  for (const char* const text : {"max 100000\n", "max\n", "0 100000\n", "100000 0\n", "x y\n", "\n"}) {
    group("mount", "cpu.max", text);
    EXPECT_EQ(quota("0::/\n"), std::nullopt) << text;
  }
}

TEST(Processors, NeverExceedTheProcessorsOfTheComputer) {
  EXPECT_GE(processors(), 1);
  EXPECT_LE(processors(), oneapi::tbb::info::default_concurrency());
}

}  // namespace
}  // namespace zerocount::parallel
