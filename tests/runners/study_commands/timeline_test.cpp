// The timeline of a run: all trials, and the serial stages that limit how it grows with the threads.
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// small_manifest(150) has 150 trials at each of two points.
class TimelineOfRun : public ProgramTest {
 protected:
  /// Trials of the spans of each stage.
  std::map<std::string, std::int64_t> trials_of_stages(const std::string& name) const {
    std::ifstream file(folder_.path() / name);
    std::map<std::string, std::int64_t> trials;
    const nlohmann::json text = nlohmann::json::parse(file);
    for (const nlohmann::json& event : text.at("traceEvents"))
      if (event.at("ph") == "X")
        trials[event.at("name")] += event.at("args").at("trials").get<std::int64_t>();
    return trials;
  }
};

TEST_F(TimelineOfRun, HasEveryTrialInEachStage) {
  folder_.write("study.yaml", small_manifest(150));
  const ProgramResult run = program({"run", "study.yaml", "-o", "study.h5", "--timeline", "time.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  std::map<std::string, std::int64_t> trials = trials_of_stages("time.json");
  for (const char* stage : {"compute", "encode", "flush", "merge", "sum"})
    EXPECT_EQ(trials[stage], 300) << stage;
  EXPECT_EQ(trials["store"], 600);  // the shards, and the file
  EXPECT_EQ(trials["read back"], 600);
}

TEST_F(TimelineOfRun, IsThatOfTheSumsWhereTheyAreKept) {
  folder_.write("study.yaml", small_manifest(150, "keep: statistics\n"));
  const ProgramResult run = program({"run", "study.yaml", "-o", "study.h5", "--timeline", "time.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(trials_of_stages("time.json")["compute"], 300);
  EXPECT_EQ(trials_of_stages("time.json")["statistics"], 300);
}

TEST_F(TimelineOfRun, ReplacesATimelineAndNothingElse) {
  folder_.write("study.yaml", small_manifest(20));
  folder_.write("notes.txt", "not a timeline\n");
  const auto run = [&](const std::string& timeline) {
    return program({"run", "study.yaml", "-o", "study.h5", "--timeline", timeline});
  };
  EXPECT_EQ(run("time.json").code, 0);
  EXPECT_EQ(run("time.json").code, 0);
  EXPECT_EQ(run("notes.txt").code, 2);
  EXPECT_EQ(run("study.h5").code, 2);
  EXPECT_EQ(run("study.yaml").code, 2);
}

TEST_F(TimelineOfRun, OfASearchHasItsStagesAndEveryLoop) {
  const std::string study = small_manifest(150);
  folder_.write("study.yaml", study.substr(0, study.find("sweep:")) +
                                  "controller: {ki: 3.85e-5}\n"
                                  "goal: {band: 1, within: 0.1, moves: 0.5}\n"
                                  "tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}}}\n");
  const ProgramResult tune = program({"tune", "study.yaml", "-o", "tuned.h5", "--budget", "20000", "--extras",
                                      "none", "--timeline", "time.json"});
  ASSERT_TRUE(tune.code == 0 || tune.code == 1 || tune.code == 3) << tune.err;
  std::map<std::string, std::int64_t> trials = trials_of_stages("time.json");
  for (const char* stage : {"tune", "search", "proof", "simulate", "margins", "compute"})
    EXPECT_TRUE(trials.contains(stage)) << stage;
  EXPECT_EQ(program({"tune", "study.yaml", "-o", "other.h5", "--timeline", "tuned.h5"}).code, 2);
}

}  // namespace
}  // namespace zerocount::testing
