// `accept` as a program: logs of machines beside a study.
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

class Accept : public ProgramTest {
 protected:
  void SetUp() override { run_study("rigs: 40\ngoal: {band: 1, within: 0.03, moves: 0.9}\n"); }

  void run_study(const std::string& more) {
    folder_.write("study.yaml", R"(zerocount: 1
name: accepted
seed: 5
trials: 4000
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [70, 150]}, alpha: 0.5}
command: {targets: [{integers: [3, 9]}], hold: 0.1}
)" + more);
    const ProgramResult run = program({"run", "study.yaml", "-o", "study.h5", "-q", "--force"});
    ASSERT_EQ(run.code, 0) << run.err;
  }
  /// A log with so many moves, of which the first so many are late.
  void write_log(const std::string& name, int moves, int late) {
    std::ofstream file(folder_.path() / name);
    file << "move,band_settling_time[1] [ms]\n";
    for (int i = 0; i < moves; ++i)
      file << i << "," << (i < late ? (i % 2 == 0 ? "31" : "") : "12.5") << "\n";
  }
  Json json_of(std::vector<std::string> words, int code) {
    words.insert(words.begin(), {"accept", "study.h5"});
    words.insert(words.end(), {"--format", "json"});
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, code) << result.out << result.err;
    return Json::parse(result.out, nullptr, false);
  }
};

TEST_F(Accept, JudgesTheMachinesByTheGoalAndThePrediction) {
  for (int i = 0; i < 3; ++i) write_log(fmt::format("good-{}.csv", i), 100, 0);
  write_log("bad.csv", 100, 30);
  write_log("few.csv", 5, 0);
  const Json good = json_of({"good-0.csv", "good-1.csv", "good-2.csv"}, 0);
  EXPECT_EQ(good["status"], "accepted");
  EXPECT_EQ(good["simulated_machines"], 40);
  EXPECT_EQ(good["goals"][0]["met"], 300);
  EXPECT_EQ(good["goals"][0]["agreement"], "consistent");
  EXPECT_NEAR(good["goals"][0]["measured_low"].get<double>(), std::pow(0.05, 1.0 / 300.0), 1e-9);
  const Json bad = json_of({"bad.csv"}, 1);
  EXPECT_EQ(bad["goals"][0]["met"], 70) << "an empty cell is late, too";
  EXPECT_EQ(bad["goals"][0]["agreement"], "differs");
  EXPECT_EQ(json_of({"few.csv"}, 3)["status"], "undecided");
}

// Few moves that meet the goal are shown by nothing, but fewer of them than predicted meet it.
TEST_F(Accept, RejectsFewerThanPredicted) {
  write_log("worse.csv", 60, 6);
  const Json worse = json_of({"worse.csv"}, 1);
  EXPECT_GT(worse["goals"][0]["measured_high"], 0.9);
  EXPECT_EQ(worse["goals"][0]["agreement"], "differs");
}

TEST_F(Accept, RefusesWhatItCannotJudge) {
  const auto message = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{"accept", "study.h5"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramResult result = program(all);
    return fmt::format("{} {}", result.code, result.err);
  };
  folder_.write("other.csv", "overshoot\n1\n");
  folder_.write("none.csv", "band_settling_time[1]\n");
  write_log("good.csv", 10, 0);
  EXPECT_EQ(message({"other.csv"}),
            "2 other.csv: has no column band_settling_time[1], which the goal asks for\n");
  EXPECT_EQ(message({"none.csv"}), "4 none.csv: has no moves; expected a row for each move of the machine\n");
  EXPECT_EQ(message({}).substr(0, 1), "2");
  EXPECT_EQ(message({"good.csv", "./good.csv"}).substr(0, 1), "2");
  EXPECT_NE(message({"good.csv", "./good.csv"}).find("is given twice"), std::string::npos);
  run_study("goal: {band: 1, within: 0.03, moves: 0.9}\n");
  EXPECT_NE(message({"good.csv"}).find("no trials share a machine"), std::string::npos);
  run_study("rigs: 40\n");
  EXPECT_NE(message({"good.csv"}).find("its manifest has no goal"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::testing
