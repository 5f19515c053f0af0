// The nightly job, run as it is on studies of a few trials.
#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class Nightly : public ::testing::Test {
 protected:
  Nightly() {
    folder_.write("small.yaml", small_manifest(30));
    folder_.write("studies.txt",
                  "# name manifest settings\nsmall small.yaml trials=20\n\nother small.yaml seed=7\n");
  }

  /// Exit code of a script of the job; what it said is in `said_`.
  int script(const std::string& name, const std::string& more = "") {
    const std::string command = fmt::format(
        "{}/{} --root {} --program {} --studies {} --baselines {} {} > {} 2>&1", ZEROCOUNT_NIGHTLY, name,
        folder_.path().string(), ZEROCOUNT_PROGRAM, (folder_ / "studies.txt").string(),
        (folder_ / "baselines").string(), more, (folder_ / "said").string());
    const int status = std::system(command.c_str());
    said_ = folder_.read("said");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  int night() { return script("nightly", "--out " + (folder_ / "out").string()); }

  std::filesystem::path last_night() const {
    std::filesystem::path last;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out")) {
      if (entry.is_directory()) last = std::max(last, entry.path());
    }
    return last;
  }

  TemporaryFolder folder_;
  std::string said_;
};

TEST_F(Nightly, PassesOnWhatItsBaselinesWereMadeOf) {
  ASSERT_EQ(script("make-baselines", "--reason 'the first ones'"), 0) << said_;
  EXPECT_TRUE(says(folder_.read("baselines/small.h5.log.yaml"), "the first ones"));
  EXPECT_TRUE(says(folder_.read("baselines/small.h5.log.yaml"), "[\"trials=20\"]"));
  ASSERT_EQ(night(), 0) << said_;
  EXPECT_TRUE(says(said_, "small: passed: every dataset is equal to the bit"));
  for (const char* name :
       {"small.h5", "small.json", "small.xml", "small.md", "small.txt", "other.xml", "summary.md"}) {
    EXPECT_TRUE(std::filesystem::exists(last_night() / name)) << name;
  }
}

TEST_F(Nightly, FindsTheRegression) {
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  folder_.write("small.yaml", small_manifest(200));
  folder_.write("studies.txt", "small small.yaml\n");
  ASSERT_EQ(script("make-baselines", "--reason 'more trials'"), 0) << said_;
  std::string slower = small_manifest(200);
  slower.replace(slower.find("3.85e-5"), 7, "1.50e-4");
  folder_.write("small.yaml", slower);
  EXPECT_EQ(night(), 1) << said_;
  EXPECT_TRUE(says(read_bytes(last_night() / "summary.md"), "regression"));
}

TEST_F(Nightly, AddsItsResultsToTheHistory) {
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  ASSERT_EQ(night(), 0) << said_;
  EXPECT_TRUE(says(said_, "history: No change is significant."));
  EXPECT_TRUE(says(read_bytes(last_night() / "summary.md"), "## History"));
  const auto runs = [&](const std::string& database) {
    const ProgramResult shown =
        zerocount_program({"history", "show", "--database", database, "--study", "small", "--point", "low",
                           "--measure", "success_rate", "--format", "csv"},
                          folder_.path());
    EXPECT_EQ(shown.code, 0) << shown.err;
    return std::count(shown.out.begin(), shown.out.end(), '\n') - 1;
  };
  EXPECT_EQ(runs("out/history.sqlite"), 2) << "the two studies, of one name and two seeds, are two series";
  const std::string page = read_bytes(last_night() / "small.html");
  EXPECT_TRUE(page.empty() || page.find("Over time") != std::string::npos);
  const std::string index = page.empty() ? "" : read_bytes(last_night() / "index.html");
  EXPECT_TRUE(page.empty() || index.find("href=\"./small.html\"") != std::string::npos);
  folder_.write("studies.txt", "small small.yaml trials=20\n");
  ASSERT_EQ(
      script("nightly", fmt::format("--out {0}/other --history {0}/mine.sqlite", folder_.path().string())), 0)
      << said_;
  EXPECT_EQ(runs("mine.sqlite"), 1);
  ASSERT_EQ(script("nightly", fmt::format("--out {}/none --history none", folder_.path().string())), 0)
      << said_;
  EXPECT_FALSE(says(said_, "history"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none/history.sqlite"));
}

// With the margins of the repository: every change fails, whichever way it goes.
TEST_F(Nightly, FindsWhatBecameBetterToo) {
  std::string slower = small_manifest(200);
  slower.replace(slower.find("3.85e-5"), 7, "1.50e-4");
  folder_.write("small.yaml", slower);
  folder_.write("studies.txt", "small small.yaml\n");
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  folder_.write("small.yaml", small_manifest(200));
  EXPECT_EQ(night(), 1) << said_;
  EXPECT_TRUE(says(read_bytes(last_night() / "summary.md"), "| better |"));
}

TEST_F(Nightly, NeverPassesWithoutABaselineOrAStudy) {
  EXPECT_EQ(night(), 4) << said_;
  EXPECT_TRUE(says(said_, "there is no baseline"));
  folder_.write("studies.txt", "# none\n");
  EXPECT_EQ(night(), 3) << said_;
  EXPECT_EQ(script("nightly", "--whatever"), 2);
}

TEST_F(Nightly, RunsTheLastStudyOfAListWithoutALineBreakAtItsEnd) {
  folder_.write("studies.txt", "small small.yaml trials=20\nother small.yaml seed=7");
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  EXPECT_EQ(night(), 0) << said_;
  EXPECT_TRUE(says(said_, "other: passed", "2 studies"));
}

TEST_F(Nightly, GoesOnAfterAStudyThatFails) {
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  folder_.write("studies.txt", "small none.yaml\nother small.yaml seed=7\n");
  EXPECT_EQ(night(), 2) << said_;
  EXPECT_TRUE(says(said_, "other: passed"));
}

}  // namespace
}  // namespace zerocount::testing
