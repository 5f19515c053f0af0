// Making and replacing a baseline, with the reason on record.
#include "analysis/comparison/comparison.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/study_files.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class Baselines : public ::testing::Test {
 protected:
  std::filesystem::path results(const std::string& name, std::int64_t first) {
    std::vector<TrialRecord> records;
    for (std::int64_t row = 0; row < 60; ++row) records.push_back(random_trial(first + row, 1));
    write_study_file(folder_ / name, plain_study(2, 30, 1), records);
    return folder_ / name;
  }

  TemporaryFolder folder_;
};

TEST_F(Baselines, AreTheResultsFileByteByByte) {
  const comparison::BaselineUpdate update =
      comparison::update_baseline(results("a.h5", 0), folder_ / "base.h5", "the first: \"it works\"");
  EXPECT_TRUE(update.changed);
  EXPECT_EQ(update.comparison, "");
  EXPECT_EQ(folder_.read("base.h5"), folder_.read("a.h5"));
  const std::string log = folder_.read("base.h5.log.yaml");
  EXPECT_NE(log.find("  reason: \"the first: \\\"it works\\\"\"\n"), std::string::npos) << log;
  EXPECT_EQ(log.find("replaces"), std::string::npos);
}

TEST_F(Baselines, KeepTheRecordOfWhatTheyReplace) {
  comparison::update_baseline(results("a.h5", 0), folder_ / "base.h5", "first");
  const std::string before = folder_.read("base.h5.log.yaml");
  const comparison::BaselineUpdate update =
      comparison::update_baseline(results("b.h5", 1000), folder_ / "base.h5", "second");
  EXPECT_NE(update.comparison, "");
  EXPECT_EQ(folder_.read("base.h5"), folder_.read("b.h5"));
  const std::string log = folder_.read("base.h5.log.yaml");
  EXPECT_TRUE(log.starts_with(before));
  EXPECT_NE(log.find("  replaces: \""), std::string::npos);
  EXPECT_NE(log.find("  comparison: \"" + update.comparison.substr(0, 8)), std::string::npos) << log;
}

TEST_F(Baselines, AreLeftAloneByTheSameFile) {
  const auto file = results("a.h5", 0);
  comparison::update_baseline(file, folder_ / "base.h5", "first");
  const std::string log = folder_.read("base.h5.log.yaml");
  EXPECT_FALSE(comparison::update_baseline(file, folder_ / "base.h5", "again").changed);
  EXPECT_EQ(folder_.read("base.h5.log.yaml"), log);
}

TEST_F(Baselines, ThatWereChangedWithoutARecordAreNoticed) {
  comparison::update_baseline(results("a.h5", 0), folder_ / "base.h5", "first");
  std::filesystem::copy_file(results("b.h5", 1000), folder_ / "base.h5",
                             std::filesystem::copy_options::overwrite_existing);
  const comparison::BaselineUpdate update =
      comparison::update_baseline(results("c.h5", 2000), folder_ / "base.h5", "third");
  ASSERT_FALSE(update.warnings.empty());
  EXPECT_NE(update.warnings[0].find("without a record"), std::string::npos);
}

TEST_F(Baselines, AreNeverMadeOfADamagedFile) {
  const auto file = results("a.h5", 0);
  std::string bytes = read_bytes(file);
  bytes[bytes.size() / 2] ^= 1;
  write_bytes(file, bytes);
  EXPECT_THROW(comparison::update_baseline(file, folder_ / "base.h5", "first"), Failure);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "base.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "base.h5.log.yaml"));
}

}  // namespace
}  // namespace zerocount::testing
