// `report FOLDER`: an index of the results files in it, with the report of each.
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

class ReportIndex : public ProgramTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "site");
    std::filesystem::create_directories(folder_.path() / "runs");
  }
  void run_study(const std::string& name, const std::string& more) {
    folder_.write("study.yaml", "zerocount: 1\nname: " + name +
                                    "\nseed: 7\ntrials: 100\ncommand: {targets: [20], hold: 0.2}\n"
                                    "controller: {ki: 3.0e-5}\n" +
                                    more);
    ASSERT_EQ(program({"run", "study.yaml", "-o", "runs/" + name + ".h5", "-q"}).code, 0);
  }
  ProgramResult index(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"report", "runs", "-o", "site/index.html"};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  }
  bool exists(const std::string& path) const { return std::filesystem::exists(folder_.path() / path); }
};

TEST_F(ReportIndex, HasTheVerdictAndTheReportOfEachFile) {
  std::filesystem::create_directories(folder_.path() / "runs" / "begun.h5.shards");
  run_study("met", "goal: {band: 30, within: 0.15, moves: 0.9}\n");
  run_study("missed", "goal: {band: 0, within: 0.0001, moves: 0.9}\n");
  run_study("sums", "keep: statistics\n");
  folder_.write("runs/damaged.h5", "no results");
  const ProgramResult result = index();
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string page = folder_.read("site/index.html");
  for (const char* text :
       {"the goal is met", "the goal is missed", "href=\"./met.html\"", "href=\"./missed.html\"", "begun.h5",
        "its run has not ended", "damaged.h5", "5 results files", ">sums</td>"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("sums.html"), std::string::npos);
  EXPECT_FALSE(exists("site/sums.html"));
  EXPECT_NE(folder_.read("site/met.html").find("Requirements"), std::string::npos);
}

TEST_F(ReportIndex, KeepsPagesThatAreAsNewAsTheirFiles) {
  run_study("one", "");
  ASSERT_EQ(index().code, 0);
  EXPECT_EQ(index().code, 2) << "the index exists";
  folder_.write("site/one.html", "mine");
  EXPECT_EQ(index({"--force"}).code, 0);
  EXPECT_EQ(folder_.read("site/one.html"), "mine");
  const auto of_file = std::filesystem::last_write_time(folder_.path() / "runs/one.h5");
  std::filesystem::last_write_time(folder_.path() / "site/one.html", of_file - std::chrono::hours(1));
  std::filesystem::remove(folder_.path() / "site/index.html");
  EXPECT_EQ(index().code, 2) << "an older page is not replaced without --force";
  EXPECT_EQ(folder_.read("site/one.html"), "mine");
  EXPECT_EQ(index({"--force"}).code, 0);
  EXPECT_NE(folder_.read("site/one.html"), "mine");
}

TEST_F(ReportIndex, RefusesWhatIsOfOneFileAndAFolderWithoutResults) {
  const ProgramResult empty = index();
  EXPECT_EQ(empty.code, 2);
  EXPECT_NE(empty.err.find("it has no results file"), std::string::npos) << empty.err;
  const ProgramResult refused = index({"--with", "limits"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("option '--with': is of one results file"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace zerocount::testing
