// How far a run or an array job has come.
#include <csignal>

#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class StatusOfARun : public ProgramTest {
 protected:
  nlohmann::json status() const {
    const ProgramResult result = program({"status", "out.h5", "--format", "json"});
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }
  void run_part(int part, const std::string& output) const {
    const ProgramResult result =
        program({"run", "study.yaml", "-q", "-o", output, "--shard", std::to_string(part) + "/4"});
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

TEST_F(StatusOfARun, IsThatOfItsShards) {
  folder_.write("study.yaml", small_manifest(200000));
  EXPECT_EQ(program({"status", "out.h5"}).code, 2);
  RunningProgram run({"run", "study.yaml", "-q", "-o", "out.h5", "--threads", "1"}, folder_.path());
  run.wait_for_shards(folder_ / "out.h5.shards");
  const nlohmann::json during = status();
  RunningProgram watch({"status", "out.h5", "--watch", "1"}, folder_.path());
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 130);
  EXPECT_EQ(watch.wait(), 4) << "nobody runs it any more";
  EXPECT_TRUE(says(program({"status", "out.h5", "--watch", "1"}).err, "has stopped"));
  EXPECT_TRUE(during["running"].get<bool>());
  EXPECT_EQ(during["trials"], 400000);
  EXPECT_GT(during["finished"], 0);
  const nlohmann::json after = status();
  EXPECT_FALSE(after["running"].get<bool>());
  EXPECT_GE(after["finished"], during["finished"]);
  const std::string text = program({"status", "out.h5"}).out;
  EXPECT_TRUE(says(text, ": not running, " + after["finished"].dump() + " of 400000 trials",
                   "unfinished"));                  // the summary
  folder_.write("out.h5.lock", "another machine");  // whose lock is not seen here
  EXPECT_TRUE(status()["running"].get<bool>());
}

TEST_F(StatusOfARun, CountsThePartsOfAnArrayJob) {
  folder_.write("study.yaml", small_manifest(60));
  fs::create_directory(folder_ / "out.h5.parts");
  run_part(1, "out.h5.parts/part-1-of-4.h5");
  run_part(4, "out.h5.parts/part-4-of-4.h5");
  fs::create_directory(folder_ / "out.h5.parts/part-3-of-4.h5.shards");
  run_part(3, "out.h5.parts/part-3-of-4.h5.shards/trials.h5");
  const nlohmann::json found = status();
  EXPECT_EQ(
      found["parts"],
      (nlohmann::json{{"all", 4}, {"complete", 2}, {"running", 0}, {"interrupted", 1}, {"waiting", 1}}));
  EXPECT_EQ(found["finished"], 90);
  EXPECT_FALSE(found["complete"].get<bool>());
  EXPECT_EQ(found["shards"], 1);
  const ProgramResult summary = program({"summary", "out.h5", "--format", "json"});
  ASSERT_EQ(summary.code, 0) << summary.err;
  EXPECT_EQ(nlohmann::json::parse(summary.out)["unfinished"]["finished"], 90);
}

TEST_F(StatusOfARun, NamesFilesThatCannotBeRead) {
  folder_.write("study.yaml", small_manifest(60));
  fs::create_directory(folder_ / "out.h5.parts");
  run_part(1, "out.h5.parts/part-1-of-4.h5");
  folder_.write("out.h5.parts/part-2-of-4.h5", "nothing");
  const nlohmann::json found = status();
  ASSERT_EQ(found["problems"].size(), 1U);
  EXPECT_TRUE(says(found["problems"][0].get<std::string>(), "part-2-of-4.h5"));
  EXPECT_EQ(found["parts"]["complete"], 1);
  const ProgramResult table = program({"status", "out.h5"});
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_TRUE(says(table.out, "no summary: "));
  fs::remove(folder_ / "out.h5.parts/part-1-of-4.h5");
  EXPECT_EQ(program({"status", "out.h5"}).code, 4);  // nothing but what cannot be read
}

TEST_F(StatusOfARun, IsRefusedOfWhatIsNoRun) {
  folder_.write("study.yaml", small_manifest(60));
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"status", "out.h5"}, {"status", "out.h5", "--watch", "1"}, {"status", "."}})
    EXPECT_EQ(program(words).code, 2) << words.back();
  EXPECT_EQ(program({"status", "study.yaml"}).code, 4);
  run_part(1, "part.h5");
  EXPECT_EQ(program({"status", "part.h5"}).code, 4);
}

TEST_F(StatusOfARun, OfPartsIsCompleteWhenTheyAreMerged) {
  folder_.write("study.yaml", small_manifest(60));
  fs::create_directory(folder_ / "out.h5.parts");
  for (const int part : {1, 2, 3, 4}) run_part(part, fmt::format("out.h5.parts/part-{}-of-4.h5", part));
  EXPECT_FALSE(status()["complete"].get<bool>());
  ASSERT_EQ(program({"merge", "out.h5.parts", "-o", "out.h5"}).code, 0);
  EXPECT_TRUE(status()["complete"].get<bool>());
  EXPECT_EQ(status()["parts"]["all"], 4);
  ASSERT_EQ(program({"run", "study.yaml", "-q", "-o", "out.h5", "--set", "trials=80"}).code, 0);
  EXPECT_EQ(status()["finished"], 160) << "trials were added to the file";
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_EQ(
      program({"run", "study.yaml", "-q", "--force", "-o", "out.h5.parts/part-2-of-4.h5", "--shard", "2/4"})
          .code,
      0);
  EXPECT_FALSE(status()["complete"].get<bool>());  // the file is older than a part
}

TEST_F(StatusOfARun, OfAFileThatIsThereIsComplete) {
  folder_.write("study.yaml", small_manifest(4));
  ASSERT_EQ(program({"run", "study.yaml", "-q", "-o", "out.h5"}).code, 0);
  const std::string text = program({"status", "out.h5"}).out;
  EXPECT_TRUE(says(text, ": complete, 8 of 8 trials (100.0 %)\nsee: zerocount summary out.h5\n"));
  EXPECT_EQ(program({"status", "out.h5", "--watch", "1"}).code, 0);
  const std::string json = program({"status", "out.h5", "--watch", "1", "--format", "json"}).out;
  EXPECT_EQ(json.find('\n'), json.size() - 1) << json;
}

}  // namespace
}  // namespace zerocount::testing
